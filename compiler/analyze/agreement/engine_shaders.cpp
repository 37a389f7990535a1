#include "analyze/agreement/engine_shaders.h"

#include "emit/template.h"
#include "verify/judge.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <set>
#include <sstream>
#include <utility>

namespace lobe::analyze {
namespace {

using Read = EngineShaders::Read;

/// templates/ue4/standins/files: what an include means.
struct Meanings {
    std::set<std::string> own;
    std::vector<std::pair<std::string, std::string>> replaced;
};

Meanings read_meanings()
{
    Meanings result;
    std::istringstream lines{std::string{*emit::embedded_template("ue4/standins/files")}};
    for (std::string line; std::getline(lines, line);) {
        std::istringstream words{line};
        std::string word;
        std::string first;
        std::string second;
        words >> word >> first >> second;
        if (word == "own") result.own.insert(first);
        if (word == "replace") result.replaced.emplace_back(first, second);
    }
    return result;
}

std::string file_name(std::string_view path)
{
    return std::string{path.substr(path.find_last_of('/') + 1)};
}

void replace_all(std::string& text, std::string_view from, std::string_view to)
{
    for (std::size_t at = 0; (at = text.find(from, at)) != text.npos; at += to.size())
        text.replace(at, from.size(), to);
}

/// The lines of ShadingCommon.ush that number the shading models: nothing else of it is needed.
std::string shading_model_ids(std::string_view text)
{
    std::string ids = "#pragma once\n";
    std::istringstream lines{std::string{text}};
    for (std::string line; std::getline(lines, line);) {
        std::istringstream words{line};
        std::string directive;
        std::string name;
        std::string value;
        words >> directive >> name >> value;
        if (directive == "#define" && name.starts_with("SHADINGMODELID_") && !value.empty())
            ids += fmt::format("#define {} {}\n", name, value);
    }
    return ids;
}

class Tree {
public:
    Tree(const EngineShaders& shaders, const Meanings& meanings, bool patched)
        : shaders_(shaders), meanings_(meanings), patched_(patched)
    {
    }

    std::optional<std::string> include(std::string_view path) const
    {
        const std::string name = file_name(path);
        const Read& read = patched_ ? shaders_.patched : shaders_.original;
        const std::string place = fmt::format("{}/{}", shaders_.folder, name);
        if (name == "ShadingCommon.ush") return shading_model_ids(read(place).value_or(""));
        if (meanings_.own.contains(name) || (patched_ && !shaders_.original(place))) {
            std::optional<std::string> text = read(place);
            if (text) {
                for (const auto& [from, to] : meanings_.replaced) replace_all(*text, from, to);
                return text;
            }
        }
        const auto standin = emit::embedded_template("ue4/standins/" + name);
        return std::string{standin.value_or("")};
    }

    /// The first complaint about a shader; empty if there is none.
    std::string judge(const std::string& text) const
    {
        const verify::Verdict verdict =
            verify::compile(text, verify::Dialect::hlsl, verify::Stage::fragment, "main",
                            [this](std::string_view name) { return include(name); });
        if (!verdict.accepted) return first_of(verdict, "glslang refuses it without a word");
        const verify::Verdict valid = verify::validate(verdict.spirv);
        return valid.accepted ? std::string{} : first_of(valid, "spirv-val refuses it");
    }

private:
    static std::string first_of(const verify::Verdict& verdict, std::string otherwise)
    {
        for (const verify::Message& message : verdict.messages)
            if (!message.text.starts_with("WARNING: ")) return message.text;
        return otherwise;
    }

    const EngineShaders& shaders_;
    const Meanings& meanings_;
    bool patched_;
};

std::string upper(std::string text)
{
    std::ranges::transform(text, text.begin(), [](unsigned char letter) {
        return static_cast<char>(std::toupper(letter));
    });
    return text;
}

emit::Record node_record(const EngineShaders& shaders)
{
    emit::Record node;
    node.texts["function"] = shaders.node_function;
    node.texts["upper"] = upper(shaders.node_function);
    node.texts["count"] = fmt::format("{}", shaders.node_inputs.size());
    auto& outputs = node.lists["outputs"];
    for (std::size_t i = 0; i < shaders.node_inputs.size(); ++i) {
        const int components = shaders.node_inputs[i];
        constexpr std::string_view all = "xyzw";
        emit::Record output;
        output.texts["type"] =
            components == 1 ? "MaterialFloat" : fmt::format("MaterialFloat{}", components);
        output.texts["index"] = fmt::format("{}", i);
        output.texts["swizzle"] =
            fmt::format(".{}", all.substr(0, static_cast<std::size_t>(components)));
        outputs.push_back(std::move(output));
    }
    return node;
}

/// A material of the model, or (without one) of the engine's first.
std::string base_pass(const EngineShaders& shaders, bool with_model, bool with_node)
{
    emit::Record values;
    values.texts["shading_model"] =
        with_model ? "SHADINGMODELID_" + shaders.shading_model : std::string{"1"};
    auto& models = values.lists["models"];
    if (with_model) {
        emit::Record model;
        model.texts["define"] = "MATERIAL_SHADINGMODEL_" + shaders.shading_model;
        models.push_back(std::move(model));
    }
    auto& nodes = values.lists["nodes"];
    if (with_node) nodes.push_back(node_record(shaders));
    return emit::render_embedded("ue4/standins/base_pass.hlsl", values).text;
}

std::string lighting(const EngineShaders& shaders, bool with_model)
{
    emit::Record values;
    values.texts["shading_model"] =
        with_model ? "SHADINGMODELID_" + shaders.shading_model : std::string{"1"};
    return emit::render_embedded("ue4/standins/lighting.hlsl", values).text;
}

}  // namespace

std::vector<EngineShaderVerdict> check_engine_shaders(const EngineShaders& shaders)
{
    const Meanings meanings = read_meanings();
    const Tree original{shaders, meanings, false};
    const Tree patched{shaders, meanings, true};
    std::vector<EngineShaderVerdict> verdicts;

    const auto compare = [&](std::string name, const std::string& before,
                             const std::string& after) {
        using Result = EngineShaderVerdict::Result;
        // The patched tree first: when it compiles, the other has nothing to add.
        std::string message = patched.judge(after);
        if (message.empty()) {
            verdicts.push_back({std::move(name), Result::compiles, {}});
            return;
        }
        std::string stock = original.judge(before);
        if (stock.empty())
            verdicts.push_back({std::move(name), Result::broken, std::move(message)});
        else
            verdicts.push_back({std::move(name), Result::unknown, std::move(stock)});
    };
    compare("lighting", lighting(shaders, false), lighting(shaders, true));
    const std::string stock_base_pass = base_pass(shaders, false, false);
    const bool has_node = !shaders.node_function.empty();
    compare("base pass", stock_base_pass, base_pass(shaders, true, has_node));
    if (has_node)
        compare("base pass without the node", stock_base_pass, base_pass(shaders, true, false));
    return verdicts;
}

}  // namespace lobe::analyze
