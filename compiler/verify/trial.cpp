// The order in which the judges are asked.
#include "verify/trial.h"

#include <algorithm>
#include <array>

namespace lobe::verify {
namespace {

struct Translation {
    const char* name;
    CrossTarget target;
};

constexpr std::array translations{
    Translation{"glsl450", CrossTarget::glsl450}, Translation{"essl310", CrossTarget::essl310},
    Translation{"hlsl50", CrossTarget::hlsl50}, Translation{"msl21", CrossTarget::msl21}};

/// glslang on what SPIRV-Cross wrote, under the rules it was written for. Nothing for Metal,
/// which no judge here reads.
void judge_again(const Translation& translation, const std::string& text, Stage stage,
                 std::vector<Step>& steps)
{
    const std::string name = std::string{translation.name} + " again";
    switch (translation.target) {
    case CrossTarget::glsl450: steps.push_back({name, compile(text, Dialect::glsl, stage)}); break;
    case CrossTarget::essl310:
        steps.push_back({name, parse_only(text, Dialect::essl, stage)});
        break;
    case CrossTarget::hlsl50: steps.push_back({name, compile(text, Dialect::hlsl, stage)}); break;
    case CrossTarget::msl21: break;
    }
}

}  // namespace

bool Trial::accepted() const { return first_refusal() == nullptr; }

const Step* Trial::first_refusal() const
{
    const auto found =
        std::ranges::find_if(steps, [](const Step& step) { return !step.verdict.accepted; });
    return found == steps.end() ? nullptr : &*found;
}

Trial chain(std::string_view text, Dialect dialect, Stage stage, Route route,
            std::string_view entry)
{
    Trial trial;
    // Says whether the step leaves something to go on with.
    const auto add = [&trial](std::string name, Verdict verdict) {
        trial.steps.push_back({std::move(name), std::move(verdict)});
        return trial.steps.back().verdict.accepted;
    };
    if (route == Route::opengl) {
        add("parse", parse_only(text, dialect, stage));
        return trial;
    }
    if (!add("compile", compile(text, dialect, stage, entry))) return trial;
    const std::vector<std::uint32_t> compiled = trial.steps.back().verdict.spirv;
    if (!add("validate", validate(compiled))) return trial;
    if (!add("optimize", optimize(compiled))) return trial;
    const std::vector<std::uint32_t> optimized = trial.steps.back().verdict.spirv;
    if (!add("validate optimized", validate(optimized))) return trial;
    for (const Translation& translation : translations)
        if (add(std::string{"to "} + translation.name,
                cross_compile(optimized, translation.target)))
            judge_again(translation, std::string{trial.steps.back().verdict.text}, stage,
                        trial.steps);
    return trial;
}

}  // namespace lobe::verify
