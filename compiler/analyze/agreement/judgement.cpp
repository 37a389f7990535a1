#include "analyze/agreement/judgement.h"

#include <algorithm>
#include <array>

namespace lobe::analyze {
namespace {

verify::Dialect dialect_of(emit::Language language)
{
    switch (language) {
    case emit::Language::glsl: return verify::Dialect::glsl;
    case emit::Language::essl: return verify::Dialect::essl;
    case emit::Language::hlsl: return verify::Dialect::hlsl;
    }
    return verify::Dialect::glsl;
}

/// Where SPIRV-Cross can take a shader, and who reads it there.
struct Crossing {
    verify::CrossTarget target;
    const char* judge;         ///< of the crossing
    const char* second_judge;  ///< of what came back; null: nobody here reads it
    verify::Dialect dialect;
};

constexpr std::array crossings{
    Crossing{verify::CrossTarget::glsl450, "cross to GLSL 4.50", "glslang on that GLSL",
             verify::Dialect::glsl},
    Crossing{verify::CrossTarget::essl310, "cross to ESSL 3.10", "glslang on that ESSL",
             verify::Dialect::essl},
    Crossing{verify::CrossTarget::hlsl50, "cross to HLSL 5.0", "glslang on that HLSL",
             verify::Dialect::hlsl},
    Crossing{verify::CrossTarget::msl21, "cross to MSL 2.1", nullptr, verify::Dialect::glsl},
};

constexpr const char* front_end = "glslang";
constexpr const char* validator = "spirv-val";
constexpr const char* optimizer = "spirv-opt -O";
constexpr const char* second_validator = "spirv-val after -O";

/// One text on its way through the judges.
class Trial {
public:
    Trial(const emit::Artifact& artifact, const emit::Target& target, int first_line)
        : artifact_(artifact), target_(target), first_line_(first_line)
    {
    }

    /// Notes a verdict; returns whether it was favorable.
    bool note(const char* judge, const verify::Verdict& verdict, bool about_artifact = false)
    {
        Judgement judgement{artifact_.path, target_.name, judge, verdict.accepted, {}};
        if (!verdict.accepted)
            for (const verify::Message& message : verdict.messages)
                judgement.remarks.push_back(remark(message, about_artifact));
        judgements_.push_back(std::move(judgement));
        return verdict.accepted;
    }

    /// The optimized SPIR-V; empty if that or the validator refused.
    std::vector<std::uint32_t> try_optimizer(const std::vector<std::uint32_t>& spirv)
    {
        if (!note(validator, verify::validate(spirv))) return {};
        verify::Verdict optimized = verify::optimize(spirv);
        if (!note(optimizer, optimized)) return {};
        if (!note(second_validator, verify::validate(optimized.spirv))) return {};
        return std::move(optimized.spirv);
    }

    void try_crossings(const std::vector<std::uint32_t>& spirv, verify::Stage stage)
    {
        for (const Crossing& crossing : crossings) {
            const verify::Verdict crossed = verify::cross_compile(spirv, crossing.target);
            if (!note(crossing.judge, crossed) || crossing.second_judge == nullptr) continue;
            // ESSL is written for OpenGL ES, with uniforms that Vulkan does not take.
            note(crossing.second_judge,
                 crossing.dialect == verify::Dialect::essl
                     ? verify::parse_only(crossed.text, crossing.dialect, stage)
                     : verify::compile(crossed.text, crossing.dialect, stage));
        }
    }

    std::vector<Judgement> finish() { return std::move(judgements_); }

private:
    Remark remark(const verify::Message& message, bool about_artifact) const
    {
        Remark out{0, message.text, std::nullopt};
        if (!about_artifact || message.line < first_line_) return out;
        out.line = message.line - first_line_ + 1;
        for (const emit::LineOrigin& origin : artifact_.origins)
            if (origin.first <= out.line && out.line <= origin.last) out.place = origin.span;
        return out;
    }

    const emit::Artifact& artifact_;
    const emit::Target& target_;
    int first_line_;
    std::vector<Judgement> judgements_;
};

}  // namespace

const std::vector<std::string>& judge_names()
{
    static const std::vector<std::string> names = [] {
        std::vector<std::string> all{front_end, validator, optimizer, second_validator};
        for (const Crossing& crossing : crossings) {
            all.emplace_back(crossing.judge);
            if (crossing.second_judge != nullptr) all.emplace_back(crossing.second_judge);
        }
        return all;
    }();
    return names;
}

std::vector<Judgement> judge_file(const emit::Artifact& artifact, const emit::Target& target)
{
    const emit::Framed framed = emit::frame(artifact, target);
    const verify::Dialect dialect = dialect_of(target.language);
    Trial trial{artifact, target, framed.first_line};
    // What only OpenGL and WebGL take; Vulkan needs GLSL 4.50 or ESSL 3.10.
    const bool parse_only = (target.language == emit::Language::glsl && target.version < 450) ||
                            (target.language == emit::Language::essl && target.version < 310);
    const verify::Verdict verdict =
        parse_only ? verify::parse_only(framed.text, dialect, verify::Stage::fragment)
                   : verify::compile(framed.text, dialect, verify::Stage::fragment);
    if (trial.note(front_end, verdict, true) && !parse_only &&
        !trial.try_optimizer(verdict.spirv).empty())
        trial.try_crossings(verdict.spirv, verify::Stage::fragment);
    return trial.finish();
}

bool Judged::accepted() const { return std::ranges::all_of(judgements, &Judgement::accepted); }

Judged judge_harness(const emit::Harness& harness, const emit::Target& target,
                     emit::Precision precision)
{
    Judged out;
    Trial trial{harness.artifact, target, 1};
    const verify::Verdict verdict = verify::compile(
        harness.artifact.text, dialect_of(target.language), verify::Stage::compute, harness.entry);
    if (trial.note(front_end, verdict, true)) {
        auto direct = verify::forbid_contraction(verdict.spirv);
        out.optimized = trial.try_optimizer(direct);
        if (!out.optimized.empty()) out.direct = std::move(direct);
        // Crossed as production would be, without NoContraction, which ESSL 3.10 cannot say.
        if (!out.direct.empty() && precision == emit::Precision::float32)
            trial.try_crossings(verdict.spirv, verify::Stage::compute);
    }
    out.judgements = trial.finish();
    return out;
}

std::vector<std::uint32_t> spirv_of(std::string_view text, const emit::Target& target,
                                    std::string_view entry)
{
    const verify::Verdict verdict =
        verify::compile(text, dialect_of(target.language), verify::Stage::compute, entry);
    if (!verdict.accepted) return {};
    auto spirv = verify::forbid_contraction(verdict.spirv);
    if (!verify::validate(spirv).accepted) return {};
    return spirv;
}

}  // namespace lobe::analyze
