// Forms that the compiler finds: they are what they say, they can be pasted, and what has none is
// left alone.
#include "analyze/minimax/minimax.h"
#include "base/render.h"
#include "compile.h"
#include "evaluate/run.h"
#include "optimize/forms.h"
#include "optimize/legal.h"
#include "optimize/optimize.h"

#include <catch2/catch.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <map>
#include <mutex>

using namespace lobe;

namespace {

const std::string header = "// A test.\nmodule m\nsource S = \"s\"\n";

std::string term(const std::string& signature, const std::string& body)
{
    return fmt::format("/// A term.\n/// S\nterm {} = {}\n", signature, body);
}

ir::Module checked(const std::string& text)
{
    Sources sources;
    Diagnostics diagnostics;
    const auto root = sources.add("m.lobe", text);
    const auto module = front(
        sources, root,
        [](Sources& all, std::string_view name, std::string_view) -> std::optional<std::uint32_t> {
            const std::string path = "../models/" + std::string{name} + ".lobe";
            std::ifstream in{path, std::ios::binary};
            if (!in) return std::nullopt;
            return all.add(path, {std::istreambuf_iterator<char>{in}, {}});
        },
        diagnostics);
    INFO(text);
    INFO(render_text(sources, diagnostics));
    REQUIRE(module);
    return *module;
}

ir::Module shipped(const std::string& name)
{
    std::ifstream in{"../models/" + name + ".lobe", std::ios::binary};
    REQUIRE(in);
    return checked({std::istreambuf_iterator<char>{in}, {}});
}

analyze::WithFoundForms with_found(const ir::Module& module, unsigned jobs = 0)
{
    return analyze::add_found_forms(module, {.jobs = jobs}, {});
}

using Columns = std::vector<std::vector<double>>;

/// A function at many points, a column per scalar of its inputs; component after component.
std::vector<double> values(const ir::Module& module, const std::string& name,
                           const Columns& columns)
{
    const auto id = module.find(name);
    REQUIRE(id);
    const evaluate::Tape tape = evaluate::compile(module, module[*id]);
    REQUIRE(tape.inputs.size() == columns.size());
    std::vector<const double*> inputs;
    for (const auto& column : columns) inputs.push_back(column.data());
    const std::size_t count = columns.front().size();
    std::vector<double> result(count * tape.outputs.size());
    std::vector<double*> outputs;
    for (std::size_t i = 0; i < tape.outputs.size(); ++i)
        outputs.push_back(result.data() + i * count);
    evaluate::run(tape, inputs, outputs, count);
    return result;
}

/// Evenly over the box of a function of one or two inputs, ends included.
Columns everywhere(const ir::Function& function)
{
    const bool plane = function.inputs.size() == 2;
    const int lines = plane ? 301 : 20001;
    const auto at = [&](std::size_t input, int i) {
        const ir::Range range = function.inputs[input].range;
        return range.low + (range.high - range.low) * i / (lines - 1);
    };
    Columns columns(function.inputs.size());
    for (int j = 0; j < (plane ? lines : 1); ++j)
        for (int i = 0; i < lines; ++i) {
            columns[0].push_back(at(0, i));
            if (plane) columns[1].push_back(at(1, j));
        }
    return columns;
}

double greatest_difference(const std::vector<double>& a, const std::vector<double>& b)
{
    double result = 0;
    for (std::size_t i = 0; i < a.size(); ++i) result = std::fmax(result, std::fabs(a[i] - b[i]));
    return result;
}

/// Names of callees, function by function: what calls mean, whatever their ids.
std::vector<std::string> calls(const ir::Module& module)
{
    std::vector<std::string> result;
    for (const ir::Function& function : module.functions)
        for (const ir::ExprId id : function.graph.ids())
            if (function.graph[id].op == ir::Op::call)
                result.push_back(function.name + " calls " +
                                 module.functions[function.graph[id].aux].name);
    return result;
}

const std::string waves =
    header + term("wave(x: unit) -> float", "exp(-3 * x) * sin(4 * x)") +
    term("twice(x: unit) -> float", "2 * wave(x)") +
    term("ramp(x: unit, y: float in [1, 2]) -> unit", "exp(-x * y) * cos(x / y)^2");

}  // namespace

TEST_CASE("found forms are forms of their terms and err as they say", "[minimax]")
{
    const auto [module, found] = with_found(checked(waves));
    CHECK(!ir::verify(module));
    CHECK(!optimize::illegal(optimize::optimize(module)));
    REQUIRE(found.size() >= 4);
    for (const analyze::FoundForm& form : found) {
        CAPTURE(form.term, form.form);
        const auto id = module.find(form.term + "_" + form.form);
        REQUIRE(id);
        const ir::Function& function = module[*id];
        CHECK(function.kind == ir::Function::Kind::form);
        CHECK(module[function.form_of].name == form.term);
        CHECK(function.form_of < *id);
        CHECK(function.doc.find("Off by up to") != std::string::npos);

        // The error is the greatest over the whole box: no point exceeds it by more than the
        // percent that a search among peaks may miss, and some come near.
        const Columns points = everywhere(function);
        const double worst = greatest_difference(values(module, function.name, points),
                                                 values(module, form.term, points));
        CHECK(worst <= form.error * 1.01 + 1e-15);
        CHECK(worst >= form.error * 0.9);
        CHECK(form.ideal <= form.error * 1.01);
    }
}

TEST_CASE("everything else in the module stays what it was", "[minimax]")
{
    const ir::Module before = checked(waves);
    const ir::Module after = with_found(before).module;
    CHECK(calls(after) == calls(before));
    for (const ir::Function& function : before.functions) CHECK(after.find(function.name));
}

TEST_CASE("a found form can be chosen like any other", "[minimax]")
{
    const auto [module, found] = with_found(checked(waves));
    const ir::Module chosen = optimize::choose(module, {{"wave", "minimax_4"}});
    const Columns points{{0, 0.1, 0.5, 0.9, 1}};
    const auto form = values(module, "wave_minimax_4", points);
    const auto twice = values(chosen, "twice", points);
    for (std::size_t i = 0; i < form.size(); ++i) CHECK(twice[i] == 2 * form[i]);
    CHECK(!optimize::illegal(optimize::optimize(chosen)));
}

TEST_CASE("a formula that is pasted into the model is the form", "[minimax]")
{
    const auto [module, found] = with_found(checked(waves));
    std::string text = waves;
    for (const analyze::FoundForm& form : found)
        if (form.term == "ramp")
            text += fmt::format("  /// S\n  form pasted_{} = {}\n", form.form, form.formula);
    const ir::Module pasted = checked(text);
    int compared = 0;
    for (const analyze::FoundForm& form : found) {
        if (form.term != "ramp") continue;
        CAPTURE(form.form, form.formula);
        const Columns points = everywhere(module[*module.find("ramp")]);
        // The text means the graph operation by operation, so not even rounding differs.
        CHECK(values(module, "ramp_" + form.form, points) ==
              values(pasted, "ramp_pasted_" + form.form, points));
        ++compared;
    }
    CHECK(compared >= 2);
}

TEST_CASE("in a term with colors the part of one scalar is approximated", "[minimax]")
{
    const std::string text =
        header + term("F(f0: color, c: unit) -> color", "f0 + (1 - f0) * (1 - c)^5");
    const auto [module, found] = with_found(checked(text));
    const auto cubic = std::ranges::find(found, "minimax_3", &analyze::FoundForm::form);
    REQUIRE(cubic != found.end());
    CHECK(module[*module.find("F_minimax_3")].type() == ir::Type::vec3);

    // (1 - f0) is at most 1, so the color errs as (1 - c)^5 does: 0.01973, see below.
    Columns points(4);
    for (int i = 0; i <= 10000; ++i) {
        for (std::size_t channel = 0; channel < 3; ++channel)
            points[channel].push_back(0.5 * static_cast<double>(channel));
        points[3].push_back(i / 10000.0);
    }
    const double worst =
        greatest_difference(values(module, "F_minimax_3", points), values(module, "F", points));
    CHECK(cubic->error == Approx(worst).epsilon(0.01));

    // Alone the power is a term of one input, and errs the same.
    const auto alone =
        with_found(checked(header + term("power(c: unit) -> float", "(1 - c)^5"))).found;
    const auto power = std::ranges::find(alone, "minimax_3", &analyze::FoundForm::form);
    REQUIRE(power != alone.end());
    CHECK(cubic->error == Approx(power->error).epsilon(1e-3));

    const ir::Module pasted = checked(text + "  /// S\n  form pasted = " + cubic->formula + "\n");
    CHECK(values(pasted, "F_pasted", points) == values(module, "F_minimax_3", points));
}

TEST_CASE("every part of a term is replaced", "[minimax]")
{
    const std::string text =
        header + term("both(d: color, g: geometry) -> color",
                      "d * (1 - 0.3 * (1 - g.cos_i)^5) * (1 - 0.3 * (1 - g.cos_o)^5)");
    const auto [module, found] = with_found(checked(text));
    REQUIRE(!found.empty());
    for (const analyze::FoundForm& form : found) {
        CAPTURE(form.form, form.formula);
        CHECK(form.formula.find("g.cos_i * ") != std::string::npos);
        CHECK(form.formula.find("g.cos_o * ") != std::string::npos);
        CHECK(form.formula.find('^') == std::string::npos);
        const ir::Module pasted = checked(text + "  /// S\n  form pasted = " + form.formula + "\n");
        const Columns points{{0, 0.3, 1}, {0, 0.3, 1}, {1, 1, 1}, {0, 0.4, 1}, {0.1, 0.6, 1}};
        CHECK(values(pasted, "both_pasted", points) == values(module, "both_" + form.form, points));
    }
}

TEST_CASE("a form stays in the range of its term", "[minimax]")
{
    const auto [module, found] =
        with_found(checked(header + term("bump(x: unit) -> unit", "sin(pi * x)^2 * exp(-x)")));
    REQUIRE(!found.empty());
    for (const analyze::FoundForm& form : found) {
        const std::string name = "bump_" + form.form;
        CAPTURE(name, form.formula);
        const ir::Function& function = module[*module.find(name)];
        CHECK(function.range.low >= 0);
        CHECK(function.range.high <= 1);
        const auto all = values(module, name, everywhere(function));
        CHECK(*std::ranges::min_element(all) >= 0);
        CHECK(*std::ranges::max_element(all) <= 1);
    }
}

TEST_CASE("a range far from 0 is centered first", "[minimax]")
{
    const auto [module, found] =
        with_found(checked(header + term("far(x: float in [1000, 1001]) -> float",
                                         "exp(x - 1000) / sqrt(x) + exp(1000 - x)")));
    REQUIRE(!found.empty());
    for (const analyze::FoundForm& form : found)
        CHECK(form.formula.find("x - 1000.5") != std::string::npos);
}

TEST_CASE("terms that no form follows are left alone", "[minimax]")
{
    const std::string body = GENERATE(
        // constant over its range, though it does not look so
        "sin(x)^2 + cos(x)^2",
        // a jump of nearly the whole range, as dear as a polynomial of high degree
        "if x < 0.3 then 0.01 * exp(sin(x)) else 1 + 0.01 * exp(-sin(x))",
        // no dearer than a line
        "2 * x");
    CAPTURE(body);
    const auto [module, found] = with_found(checked(header + term("hostile(x: unit)", body)));
    CHECK(found.empty());
    CHECK(!ir::verify(module));
}

TEST_CASE("what has no bounded scalar inputs is left alone", "[minimax]")
{
    const std::string signature = GENERATE(
        "hostile(x: float)", "hostile(x: float in [0, 1], y: unit, z: unit)", "hostile(x: int)");
    CAPTURE(signature);
    const std::string body =
        signature.find("z:") == std::string::npos ? "exp(-abs(x)) * sin(x)" : "exp(-x * y * z)";
    CHECK(with_found(checked(header + term(signature, body))).found.empty());
}

TEST_CASE("what was found once is kept", "[minimax]")
{
    std::map<std::string, std::string, std::less<>> memory;
    std::mutex mutex;
    int saved = 0;
    const analyze::Store store{[&](std::string_view key) -> std::optional<std::string> {
                                   const std::lock_guard lock{mutex};
                                   const auto found = memory.find(key);
                                   return found == memory.end() ? std::nullopt
                                                                : std::optional{found->second};
                               },
                               [&](std::string_view key, std::string_view made) {
                                   const std::lock_guard lock{mutex};
                                   memory.emplace(key, made);
                                   ++saved;
                               }};
    const ir::Module module = checked(waves);
    const auto first = analyze::add_found_forms(module, {}, store);
    const int fits = saved;
    CHECK(fits > 0);
    const auto second = analyze::add_found_forms(module, {}, store);
    CHECK(saved == fits);
    REQUIRE(first.found.size() == second.found.size());
    for (std::size_t i = 0; i < first.found.size(); ++i) {
        CHECK(first.found[i].formula == second.found[i].formula);
        CHECK(first.found[i].error == second.found[i].error);
    }
    // Another term's fit is another key.
    analyze::add_found_forms(checked(header + term("wave(x: unit) -> float", "exp(-4 * x)*sin(x)")),
                             {}, store);
    CHECK(saved > fits);
}

TEST_CASE("found forms do not depend on the number of threads", "[minimax]")
{
    const ir::Module module = shipped("ue4");
    const auto one = with_found(module, 1);
    const auto four = with_found(module, 4);
    REQUIRE(one.found.size() == four.found.size());
    for (std::size_t i = 0; i < one.found.size(); ++i) {
        CHECK(one.found[i].term == four.found[i].term);
        CHECK(one.found[i].formula == four.found[i].formula);
        CHECK(one.found[i].error == four.found[i].error);
    }
}

TEST_CASE("shipped models with what was found for them are models", "[minimax]")
{
    const std::string name = GENERATE("microfacet", "callisto", "ue4", "environment");
    CAPTURE(name);
    const ir::Module before = shipped(name);
    // Few shapes: what they are is not asked here, and finding many takes seconds.
    const auto [module, found] = analyze::add_found_forms(before, {.max_degree = 3}, {});
    CHECK(module.functions.size() == before.functions.size() + found.size());
    const auto broken = ir::verify(module);
    INFO(broken.value_or(""));
    CHECK(!broken);
    const auto illegal = optimize::illegal(optimize::optimize(module));
    INFO(illegal.value_or(""));
    CHECK(!illegal);
}
