// Errors are what calculus and the number formats say they are, nothing on a frontier is missed,
// and what dominates what is told truly.
#include "analyze/trade/text.h"
#include "analyze/trade/trade.h"
#include "base/render.h"
#include "compile.h"

#include <catch2/catch.hpp>
#include <fmt/format.h>

#include <cmath>
#include <map>
#include <mutex>

using namespace lobe;
using analyze::Candidate;
using analyze::Family;
using analyze::Format;
using analyze::Trade;
using Catch::Detail::Approx;
using optimize::Spelling;

namespace {

constexpr double half_ulp = 0x1p-24;  // of a float near 1
constexpr Family rdna2 = Family::rdna2;

struct Checked {
    Sources sources;
    std::optional<ir::Module> module;
};

Checked checked_text(const std::string& text)
{
    Checked out;
    Diagnostics diagnostics;
    const auto root = out.sources.add("m.lobe", "module m\n" + text);
    out.module = front(
        out.sources, root,
        [](Sources&, std::string_view, std::string_view) -> std::optional<std::uint32_t> {
            return std::nullopt;
        },
        diagnostics);
    INFO(render_text(out.sources, diagnostics));
    REQUIRE(out.module);
    return out;
}

/// Stands in for a driver: one cycle per operation of the tape, more for what is dear.
double cycles_of(const evaluate::Tape& tape)
{
    double sum = 0;
    for (const evaluate::Instruction& step : tape.code) switch (step.op) {
        case evaluate::TapeOp::power: sum += 9; break;
        case evaluate::TapeOp::divide:
        case evaluate::TapeOp::exp2:
        case evaluate::TapeOp::square_root: sum += 4; break;
        default: sum += 1;
        }
    return sum;
}

analyze::Costs counted(std::span<const analyze::CostSubject> subjects)
{
    analyze::Costs out;
    for (const analyze::CostSubject& subject : subjects) {
        analyze::Cost& cost = out.costs.emplace_back();
        const analyze::Spelled spelled{*subject.module, subject.functions};
        const double cycles = cycles_of(analyze::tape_of(spelled));
        for (const analyze::Family family : analyze::all_families)
            cost.families[family].issue = (family < analyze::Family::rdna1 ? 4 * cycles : cycles) *
                                          (subject.format == Format::packed16 ? 0.5 : 1);
    }
    return out;
}

analyze::ParetoOptions few_points(std::size_t points = 4096)
{
    analyze::ParetoOptions options;
    options.points = points;
    return options;
}

Trade of_term(const ir::Module& module, const std::string& name, unsigned jobs = 0)
{
    const auto term = module.find(name);
    REQUIRE(term);
    analyze::ParetoOptions options = few_points();
    options.cost.jobs = jobs;
    return analyze::trade(analyze::TradeSubject::of_term(module, *term), {}, options, counted, {});
}

const Candidate& find(const Trade& trade, const std::string& description)
{
    for (const Candidate& candidate : trade.candidates)
        if (describe(candidate) == description) return candidate;
    FAIL("no candidate " << description);
    return trade.candidates.front();
}

bool has(const Trade& trade, const std::string& description)
{
    return std::ranges::any_of(trade.candidates, [&](const Candidate& candidate) {
        return describe(candidate) == description;
    });
}

/// A candidate of a hand-made trade.
Candidate made(double cycles, double error)
{
    Candidate out;
    out.total.scaled = error;
    out.total.points = 100;
    out.spelling = Spelling::stable;
    for (const analyze::Family family : analyze::all_families)
        out.cost.families[family].issue = cycles;
    return out;
}

}  // namespace

TEST_CASE("display codes are those of the sRGB curve")
{
    CHECK(analyze::display_code(0) == 0);
    CHECK(analyze::display_code(1) == Approx(255));
    CHECK(analyze::display_code(-1) == 0);
    CHECK(analyze::display_code(7) == Approx(255));
    CHECK(analyze::display_code(0.001) == Approx(255 * 12.92 * 0.001));
    // 1.055 0.5^(1/2.4) - 0.055 = 0.7353569831
    CHECK(analyze::display_code(0.5) == Approx(255 * 0.7353569831));
    for (const double code : {0.0, 3.0, 11.0, 128.0, 254.5, 255.0})
        CHECK(analyze::display_code(analyze::linear_of_code(code)) == Approx(code).margin(1e-6));
}

TEST_CASE("the error over the reals of a form is the one computed by hand")
{
    // |0.09| over max(x^2, 0.18): 0.5 wherever x^2 < 0.18; and 0.09 of an absolute error always.
    const Checked checked = checked_text("/// X.\nterm f(x: unit) -> float = x^2\n"
                                         "  /// Off.\n  form off = x^2 + 0.09\n");
    const Trade trade = of_term(*checked.module, "f");
    const Candidate& form = find(trade, "f: off");
    CHECK(form.model.scaled == Approx(0.5).epsilon(1e-12));
    CHECK(form.model.absolute == Approx(0.09).epsilon(1e-12));
    // Of x uniform in [0, 1] the error is 0.09 / x^2 above sqrt(0.18): the median is at x = 1/2.
    // 2048 usual points stray by 0.5 / sqrt(2048) of probability per sigma; the slope there is
    // 2 * 0.09 / x^3 = 1.44.
    CHECK(form.model.typical == Approx(0.36).margin(5 * 1.44 * 0.5 / std::sqrt(2048)));
    CHECK(form.model.codes ==
          Approx(analyze::display_code(0.09) - analyze::display_code(0)).epsilon(0.01));
    // A square and a sum of at most 1.09, each rounded once.
    CHECK(form.rounding.scaled > 0);
    CHECK(form.rounding.scaled < 4 * half_ulp);
    CHECK(find(trade, "definition").model.scaled == 0);
    CHECK(find(trade, "definition").total.scaled == find(trade, "definition").rounding.scaled);
}

TEST_CASE("rounding is that of the number format")
{
    // Near 2^14 floats are 2^-9 apart and halves 16: half of that is lost, once, and the
    // difference is exact.
    const Checked checked = checked_text("/// X.\nterm f(x: unit) -> float {\n"
                                         "  let y = x + 16384\n  y - 16384\n}\n"
                                         "  /// Exact.\n  form exact = x\n");
    const Trade trade = of_term(*checked.module, "f");
    const Candidate& lossy = find(trade, "definition");
    CHECK(lossy.rounding.absolute <= 0x1p-10);
    CHECK(lossy.rounding.absolute > 0.95 * 0x1p-10);
    CHECK(lossy.rounding.scaled <= 0x1p-10 / 0.18);
    // In half x is lost altogether: where it counts against itself that is 100 %.
    CHECK(find(trade, "definition; half").total.scaled == Approx(1));
    CHECK(find(trade, "f: exact").total.scaled == 0);
    // Half an ulp of a half is 2^-11 of a power of two; below 0.18 it counts less.
    CHECK(find(trade, "f: exact; half").total.scaled == Approx(0x1p-11).epsilon(0.01));
}

TEST_CASE("what is proved of rounding holds for what was observed, and is not far from it")
{
    const Checked checked = checked_text("/// X.\nterm f(x: unit) -> float = x^2 + 0.09\n"
                                         "  /// Off.\n  form off = x^2\n");
    const Trade trade = of_term(*checked.module, "f");
    for (const std::string name : {"definition", "f: off"}) {
        CAPTURE(name);
        const Candidate& ways = find(trade, name);
        REQUIRE(ways.proved);
        // Its inputs are arguments, as the proof's are: the two measure the same.
        CHECK(ways.rounding.scaled <= ways.proved->bound);
        CHECK(ways.proved->observed <= ways.proved->bound);
        // A square and a sum: at most two halves of an ulp, and a proof may stop at 4 times that.
        CHECK(ways.proved->bound <= 4 * 2 * half_ulp);
        CHECK(ways.proved->any_device >= ways.proved->bound);
        CHECK(ways.proved->over.empty());
        const Candidate& half = find(trade, name + "; half");
        REQUIRE(half.proved);
        CHECK(half.proved->bound <= 4 * 2 * 0x1p-11);
        CHECK(find(trade, name + "; packed half").proved->bound == half.proved->bound);
    }
    // It survives being kept.
    const std::string text = to_text(trade);
    const auto again = analyze::read_trade(text);
    REQUIRE(again);
    CHECK(to_text(*again) == text);
    CHECK(find(*again, "f: off; half").proved->bound == find(trade, "f: off; half").proved->bound);
    // A proof takes time that a build does not need.
    analyze::ParetoOptions options = few_points();
    options.proofs = false;
    const Trade without =
        analyze::trade(analyze::TradeSubject::of_term(*checked.module, *checked.module->find("f")),
                       {}, options, counted, {});
    CHECK_FALSE(find(without, "definition").proved);
}

TEST_CASE("half is proved where it is finite")
{
    const Checked checked =
        checked_text("/// X.\nterm f(x: float in [0.001, 1]) -> float = 1 / x^2\n"
                     "  /// Off.\n  form off = 1 / x\n");
    const Trade trade = of_term(*checked.module, "f");
    // 10^6 is no half; 1 / x is at most 1,000.
    REQUIRE(find(trade, "definition; half").proved);
    CHECK_THAT(find(trade, "definition; half").proved->over, Catch::StartsWith("x in ["));
    CHECK(std::isfinite(find(trade, "definition; half").proved->bound));
    CHECK(find(trade, "definition").proved->over.empty());
    CHECK(find(trade, "f: off; half").proved->over.empty());
}

TEST_CASE("the same text is one candidate")
{
    const Checked checked = checked_text("/// X.\nterm f(x: unit) -> float = x + 0.25\n"
                                         "  /// The same.\n  form same = 0.25 + x\n"
                                         "  /// Not.\n  form other = 2 * x\n");
    const Trade trade = of_term(*checked.module, "f");
    CHECK(has(trade, "definition"));
    CHECK(has(trade, "f: other"));
    CHECK_FALSE(has(trade, "f: same"));
    CHECK_FALSE(has(trade, "definition; as written"));
}

TEST_CASE("the naive spelling shows where it is undefined")
{
    const Checked checked = checked_text("/// X.\nterm f(g: geometry) -> float {\n"
                                         "  g.cos_i * g.cos_o / max(g.cos_i, g.cos_o) else 0\n}\n");
    const Trade trade = of_term(*checked.module, "f");
    const Candidate& naive = find(trade, "definition; naive");
    CHECK(naive.total.not_finite > 0);
    CHECK_FALSE(naive.selectable);
    CHECK(std::isinf(trade.error_of(naive)));
    CHECK(find(trade, "definition").total.not_finite == 0);
    CHECK(trade.from_vectors);
}

TEST_CASE("a table is off by its interpolation and its texels")
{
    // A parabola in x, straight in y: between texels h apart it is off by h^2 / 8 times the second
    // derivative, 2 * 16 / 4096, at the middle of every cell.
    const Checked checked = checked_text("/// X.\nterm f(x: unit, y: unit) -> float =\n"
                                         "  sum i in 0 .. 15 { ((x + i)^2 + y * i) / 4096 }\n");
    const Trade trade = of_term(*checked.module, "f");
    for (const int size : {32, 128}) {
        CAPTURE(size);
        const double h = 1.0 / (size - 1);
        const double exact = h * h / 8 * 2 * 16 / 4096;
        const Candidate& table = find(trade, fmt::format("f: table {0} x {0}, unorm 16", size));
        // In x at most 2 * 16 * 8.5 / 4096 per unit, in y 16 * 7.5 / 4096. Texels stand on floats.
        const double slope = (2 * 16 * 8.5 + 16 * 7.5) / 4096;
        CHECK(table.model.absolute <= exact + slope * half_ulp);
        CHECK(table.model.absolute > 0.98 * exact);
        CHECK_FALSE(table.selectable);
        // Half a step of a texel, and half of 1/256 of what a cell rises.
        CHECK(table.rounding.absolute <= 0.5 / 65535 + slope * h / 512 + 1e-9);
        CHECK(table.rounding.absolute > 0.25 / 65535);
        // Halves near 0.5 are 2^-12 apart or more.
        const Candidate& half = find(trade, fmt::format("f: table {0} x {0}, half", size));
        CHECK(half.total.absolute > table.total.absolute);
    }
}

TEST_CASE("what is dominated names the cheapest that does it")
{
    Trade trade;
    trade.candidates = {made(10, 0.1), made(5, 0.2), made(10, 0.2), made(12, 0.3), made(5, 0.2),
                        made(4, 0.05), made(3, 0.5), made(2, 0.01), made(11, 0.3)};
    trade.candidates[5].spelling = Spelling::naive;  // dominates nothing
    trade.candidates[6].total.not_finite = 1;        // and neither does what is not finite
    // What cannot be emitted dominates only its like.
    trade.candidates[7].selectable = trade.candidates[8].selectable = false;
    analyze::judge(trade);
    const auto standing = [&](std::size_t i) { return trade.candidates[i].standing.at(rdna2); };
    CHECK(standing(0).on_frontier);
    CHECK(standing(1).on_frontier);
    CHECK(standing(2).dominated_by == 1);
    CHECK(standing(3).dominated_by == 1);
    CHECK(standing(4).on_frontier);  // equal in both to another
    CHECK_FALSE(standing(5).on_frontier);
    CHECK_FALSE(standing(6).on_frontier);
    CHECK_FALSE(standing(6).dominated_by);
    CHECK(standing(7).on_frontier);
    CHECK(standing(8).dominated_by == 7);
}

TEST_CASE("limits pick the cheapest and the most accurate")
{
    Trade trade;
    trade.candidates = {made(10, 0.01), made(8, 0.02), made(8, 0.03), made(2, 0.015)};
    trade.candidates[3].selectable = false;
    CHECK(analyze::cheapest_within(trade, Family::rdna2, 0.05) == 1);
    CHECK(analyze::cheapest_within(trade, Family::rdna2, 0.01) == 0);
    CHECK_FALSE(analyze::cheapest_within(trade, Family::rdna2, 0.001));
    CHECK(analyze::most_accurate_within(trade, Family::rdna2, 9) == 1);
    CHECK(analyze::most_accurate_within(trade, Family::rdna2, 10) == 0);
    CHECK_FALSE(analyze::most_accurate_within(trade, Family::rdna2, 7));
}

namespace {

/// Three terms with four forms each, so that they share work: what a form costs depends on the
/// others.
std::string joint_model()
{
    std::string text = "\nparam gain: float in [0, 4] = 1\n";
    for (const std::string term : {"a", "b", "c"}) {
        const std::string offset = term == "a" ? "0.1" : term == "b" ? "0.2" : "0.3";
        text += "/// T.\nterm " + term + "(x: unit) -> float = sqrt(x + " + offset +
                ") * (1 - x)^5 + 2^x\n";
        text += "  /// F.\n  form one = sqrt(x + " + offset + ") * (1 - x)^4 + 2^x\n";
        text += "  /// F.\n  form two = sqrt(x + " + offset + ") * (1 - x)^4 + 1 + x\n";
        text += "  /// F.\n  form three = (x + " + offset + ") * (1 - x)^5 + 2^x\n";
        text += "  /// F.\n  form four = 1 + x\n";
    }
    return text + "/// M.\nmodel m(g: geometry, s: surface) {\n"
                  "  diffuse = gain * a(g.cos_i) * b(g.cos_o) * s.diffuse_color * g.cos_i\n"
                  "  specular = c(g.cos_d) * s.f0 * g.cos_i\n}\n";
}

Trade joint(const ir::Module& module, const analyze::ParetoOptions& options,
            const analyze::Store& store = {})
{
    return analyze::trade(analyze::TradeSubject::of_model(module, module.models.front()), {},
                          options, counted, store);
}

/// Of what is off by no more than there is.
std::map<std::string, double> frontier_of(const Trade& trade, Family family)
{
    std::map<std::string, double> out;
    for (const Candidate& candidate : trade.candidates)
        if (candidate.standing.at(family).on_frontier && trade.error_of(candidate) <= 1)
            out[describe(candidate)] = trade.error_of(candidate);
    return out;
}

}  // namespace

TEST_CASE("no joint choice on a frontier is missed by what is not measured")
{
    const Checked checked = checked_text(joint_model());
    analyze::ParetoOptions options = few_points(2048);
    const Trade searched = joint(*checked.module, options);
    options.every_cost = true;
    const Trade all = joint(*checked.module, options);
    CAPTURE(searched.search);
    CHECK(searched.candidates.size() < all.candidates.size());
    for (const analyze::Family family : analyze::all_families)
        CHECK(frontier_of(searched, family) == frontier_of(all, family));
    CHECK(frontier_of(all, rdna2).size() > 5);
    // The error of what nobody changed is float's alone.
    CHECK(all.candidates.front().total.often < 64 * half_ulp);
}

TEST_CASE("equal questions have equal answers on any number of threads, and again from the store")
{
    const Checked checked = checked_text(joint_model());
    analyze::ParetoOptions options = few_points(2048);
    options.cost.jobs = 1;
    std::map<std::string, std::string, std::less<>> kept;
    std::mutex lock;
    int loaded = 0;
    const analyze::Store store{[&](std::string_view key) -> std::optional<std::string> {
                                   const std::scoped_lock guard{lock};
                                   const auto found = kept.find(key);
                                   if (found == kept.end()) return std::nullopt;
                                   ++loaded;
                                   return found->second;
                               },
                               [&](std::string_view key, std::string_view value) {
                                   const std::scoped_lock guard{lock};
                                   kept[std::string{key}] = value;
                               }};
    const Trade one = joint(*checked.module, options, store);
    CHECK(loaded == 0);
    options.cost.jobs = 3;
    const Trade three = joint(*checked.module, options);
    const Trade again = joint(*checked.module, options, store);
    CHECK(loaded > 0);
    REQUIRE(one.candidates.size() == three.candidates.size());
    REQUIRE(one.candidates.size() == again.candidates.size());
    for (std::size_t i = 0; i < one.candidates.size(); ++i)
        for (const Trade* other : {&three, &again}) {
            const Candidate& a = one.candidates[i];
            const Candidate& b = other->candidates[i];
            CHECK(describe(a) == describe(b));
            CHECK(a.total.scaled == b.total.scaled);
            CHECK(a.total.often == b.total.often);
            CHECK(a.model.typical == b.model.typical);
            CHECK(a.rounding.root_mean_square == b.rounding.root_mean_square);
            CHECK(a.total.at == b.total.at);
            CHECK(a.standing.at(rdna2).dominated_by == b.standing.at(rdna2).dominated_by);
        }
}
