// SPIRV-Cross as a judge: can what we compiled be said again in another language?
//
// GLSL 4.50 is asked for as Vulkan has it and ESSL 3.10 as OpenGL ES has it, where a push constant
// is a plain uniform: the ways in which each is used.
#include "verify/judge.h"

#include <spirv_cross/spirv_glsl.hpp>
#include <spirv_cross/spirv_hlsl.hpp>
#include <spirv_cross/spirv_msl.hpp>

#include <exception>

namespace lobe::verify {
namespace {

using Words = std::vector<std::uint32_t>;

std::string to_glsl450(Words spirv)
{
    spirv_cross::CompilerGLSL compiler{std::move(spirv)};
    auto options = compiler.get_common_options();
    options.version = 450;
    options.es = false;
    options.vulkan_semantics = true;
    compiler.set_common_options(options);
    return compiler.compile();
}

std::string to_essl310(Words spirv)
{
    spirv_cross::CompilerGLSL compiler{std::move(spirv)};
    auto options = compiler.get_common_options();
    options.version = 310;
    options.es = true;
    options.vulkan_semantics = false;
    options.fragment.default_float_precision = spirv_cross::CompilerGLSL::Options::Highp;
    compiler.set_common_options(options);
    return compiler.compile();
}

std::string to_hlsl50(Words spirv)
{
    spirv_cross::CompilerHLSL compiler{std::move(spirv)};
    auto options = compiler.get_hlsl_options();
    options.shader_model = 50;
    compiler.set_hlsl_options(options);
    return compiler.compile();
}

std::string to_msl21(Words spirv)
{
    spirv_cross::CompilerMSL compiler{std::move(spirv)};
    auto options = compiler.get_msl_options();
    options.set_msl_version(2, 1);
    compiler.set_msl_options(options);
    return compiler.compile();
}

std::string to(CrossTarget target, Words spirv)
{
    switch (target) {
    case CrossTarget::glsl450: return to_glsl450(std::move(spirv));
    case CrossTarget::essl310: return to_essl310(std::move(spirv));
    case CrossTarget::hlsl50: return to_hlsl50(std::move(spirv));
    case CrossTarget::msl21: return to_msl21(std::move(spirv));
    }
    return {};
}

}  // namespace

Verdict cross_compile(std::span<const std::uint32_t> spirv, CrossTarget target)
{
    Verdict verdict;
    try {
        verdict.text = to(target, Words{spirv.begin(), spirv.end()});
        verdict.accepted = true;
    } catch (const std::exception& refusal) {  // how SPIRV-Cross says no
        verdict.messages.push_back({0, refusal.what()});
    }
    return verdict;
}

}  // namespace lobe::verify
