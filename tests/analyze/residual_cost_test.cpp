// What only the effects of a scene cost: at the base exactly what a person's own base model costs.
#include "analyze/checked.h"
#include "analyze/cost/cost.h"
#include "emit/emit.h"
#include "optimize/optimize.h"
#include "optimize/residual.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cctype>
#include <map>
#include <set>
#include <sstream>

using namespace lobe;
using namespace lobe::analyze;
using tests::Checked;
using tests::checked_model;
using tests::checked_text;

namespace {

/// Of both outputs of a model together.
CostSubject subject_of(const ir::Module& module, const std::string& model, bool from_vectors)
{
    CostSubject subject;
    subject.module = &module;
    subject.from_vectors = from_vectors;
    for (const ir::Model& each : module.models)
        if (each.name == model)
            for (const ir::ModelOutput& output : each.outputs)
                subject.functions.push_back(output.function);
    REQUIRE(subject.functions.size() == 2);
    return subject;
}

/// Nothing but defaults, and no effect.
ir::Module base_of(const ir::Module& callisto)
{
    optimize::Called nothing;
    nothing.constants = optimize::defaults(callisto);
    for (const ir::Effect& effect : callisto.effects) nothing.off.insert(effect.name);
    return optimize::optimize(optimize::residual(callisto, nothing, "callisto").module);
}

/// The functions and structures of a shader, without comments, each with its own names: `a0` is
/// the first one that occurs. What the language itself names stays.
std::multiset<std::string> parts_of(const ir::Module& module, const Sources& sources)
{
    static const std::set<std::string> words{"float", "vec3",        "return", "struct",
                                             "sqrt",  "max",         "min",    "clamp",
                                             "dot",   "inversesqrt", "pow",    "exp2"};
    const std::string text = emit::emit(module, sources, *emit::find_target("glsl450"))[0].text;
    std::multiset<std::string> parts;
    std::map<std::string, std::string> names;
    std::string part;
    const auto end_part = [&] {
        if (!part.empty()) parts.insert(part);
        part.clear();
        names.clear();
    };
    std::istringstream lines{text};
    for (std::string line; std::getline(lines, line);) {
        const std::size_t start = line.find_first_not_of(' ');
        if (start == std::string::npos || line[start] == '#') end_part();
        if (start == std::string::npos || line[start] == '#' || line.compare(start, 2, "//") == 0)
            continue;
        for (std::size_t i = start; i < line.size();) {
            std::size_t end = i;
            while (end < line.size() &&
                   (std::isalnum(static_cast<unsigned char>(line[end])) != 0 || line[end] == '_'))
                ++end;
            const std::string word = line.substr(i, std::max<std::size_t>(1, end - i));
            const bool is_name = end > i && std::isdigit(static_cast<unsigned char>(word[0])) == 0;
            if (is_name && !words.contains(word))
                part += names.try_emplace(word, "a" + std::to_string(names.size())).first->second;
            else if (word != " ")
                part += word;
            // Words stay apart.
            if (end > i) part += ' ';
            i += word.size();
        }
    }
    end_part();
    return parts;
}

}  // namespace

TEST_CASE("a scene that calls for nothing gets the text of the base model")
{
    const Checked callisto = checked_model("../models/callisto.lobe");
    const Checked written = checked_model("data/residual/base.lobe");
    CHECK(parts_of(base_of(callisto.module), callisto.sources) ==
          parts_of(optimize::optimize(written.module), written.sources));
}

TEST_CASE("choosing between colors costs no more than blending them")
{
    const Checked checked = checked_text(R"(
module test
model test(g: geometry, s: surface) {
  diffuse = lerp(s.diffuse_color, s.base_color, s.metallic) * g.cos_i
  specular = lerp(s.f0, s.base_color, s.metallic) * g.cos_i
}
)");
    optimize::Called called;
    const ir::Module blended =
        optimize::optimize(optimize::residual(checked.module, called, "test").module);
    called.binary = {"metallic"};
    const ir::Module chosen =
        optimize::optimize(optimize::residual(checked.module, called, "test").module);
    const std::vector<CostSubject> subjects{subject_of(chosen, "test", false),
                                            subject_of(blended, "test", false)};
    const Costs costs = measure_costs(subjects, checked.sources, {}, {});
    REQUIRE(costs.no_statistics.empty());
    for (const Family family : all_families) {
        CAPTURE(title(family));
        CHECK(issue_on(costs.costs[0], family) < issue_on(costs.costs[1], family));
    }
}

TEST_CASE("a scene that calls for nothing costs what the base model costs")
{
    const Checked callisto = checked_model("../models/callisto.lobe");
    const Checked written = checked_model("data/residual/base.lobe");
    const ir::Module left = base_of(callisto.module);
    const ir::Module base = optimize::optimize(written.module);
    const ir::Module full = optimize::optimize(callisto.module);

    for (const bool from_vectors : {false, true}) {
        CAPTURE(from_vectors);
        const std::vector<CostSubject> subjects{subject_of(left, "callisto", from_vectors),
                                                subject_of(base, "base", from_vectors),
                                                subject_of(full, "callisto", from_vectors)};
        // Costs name functions, never sources.
        const Costs costs = measure_costs(subjects, callisto.sources, {}, {});
        INFO(costs.no_statistics);
        REQUIRE(costs.no_statistics.empty());
        REQUIRE(costs.costs.size() == 3);
        CHECK(costs.costs[0].spirv_instructions == costs.costs[1].spirv_instructions);
        for (const Family family : all_families) {
            CAPTURE(title(family));
            const double residual = issue_on(costs.costs[0], family);
            CHECK(residual > 0);
            CHECK(residual == issue_on(costs.costs[1], family));
            CHECK(costs.costs[0].families.at(family).vgprs ==
                  costs.costs[1].families.at(family).vgprs);
        }
        // What every material pays for effects that none of them uses.
        INFO(issue_on(costs.costs[2], Family::rdna2)
             << " cycles against " << issue_on(costs.costs[0], Family::rdna2));
        CHECK(issue_on(costs.costs[2], Family::rdna2) >=
              2 * issue_on(costs.costs[0], Family::rdna2));
    }
}
