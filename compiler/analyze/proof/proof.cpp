#include "analyze/proof/proof.h"

#include "analyze/proof/bounds.h"
#include "analyze/proof/finite.h"
#include "analyze/tasks.h"
#include "evaluate/bounds.h"
#include "evaluate/intervals.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <map>
#include <mutex>
#include <string_view>

namespace lobe::analyze {
namespace {

using evaluate::Interval;
using evaluate::Machine;
using evaluate::Precision;
using nlohmann::json;

constexpr std::size_t most_open_told = 16;
/// Bounds sharper than this times the observed error are not worth more time.
constexpr double sharp = 4;
/// A device may round to either side and approximates more: its bound is further from what a CPU
/// does.
constexpr double sharp_vulkan = 16;
/// The better of both measures is divided on while it is above this.
constexpr double wanted = 8;
/// How often worse points are looked for where it is.
constexpr std::uint64_t most_rounds = 16;

// ---- a proof as text

/// Infinities are no JSON numbers.
json number(double value) { return value < evaluate::infinity ? json(value) : json("infinite"); }
double number(const json& value)
{
    return value.is_number() ? value.get<double>() : evaluate::infinity;
}

json text_of(const ErrorBound& bound)
{
    return {{"absolute", number(bound.absolute)},
            {"relative", number(bound.relative)},
            {"observed_absolute", number(bound.observed_absolute)},
            {"observed_relative", number(bound.observed_relative)},
            {"at", bound.at},
            {"jump", number(bound.jump)},
            {"observed_jump", number(bound.observed_jump)}};
}

ErrorBound bound_of(const json& text)
{
    return {number(text["absolute"]),          number(text["relative"]),
            number(text["observed_absolute"]), number(text["observed_relative"]),
            text["at"].get<std::string>(),     number(text["jump"]),
            number(text["observed_jump"])};
}

json text_of(const NamedBox& box)
{
    json sides = json::array();
    for (const auto& [name, side] : box.sides) sides.push_back({name, side.low, side.high});
    return sides;
}

NamedBox box_of(const json& text)
{
    NamedBox box;
    for (const json& side : text)
        box.sides.emplace_back(side[0].get<std::string>(),
                               Interval{side[1].get<double>(), side[2].get<double>()});
    return box;
}

std::string text_of(const Proof& proof)
{
    json open = json::array();
    for (const NamedBox& box : proof.open) open.push_back(text_of(box));
    const json text{{"finite", proof.finite},
                    {"open", open},
                    {"open_count", proof.open_count},
                    {"open_tested", proof.open_tested},
                    {"open_not_finite", proof.open_not_finite},
                    {"over", proof.over ? text_of(*proof.over) : json()},
                    {"refused", proof.refused},
                    {"floor", proof.floor},
                    {"ieee", text_of(proof.ieee)},
                    {"vulkan", text_of(proof.vulkan)},
                    {"boxes", proof.boxes}};
    return text.dump();
}

/// Nothing for a text that is no proof: a store may be damaged.
std::optional<Proof> proof_of(const std::string& text)
{
    const json read = json::parse(text, nullptr, false);
    if (!read.is_object() || !read.contains("vulkan") || !read.contains("boxes"))
        return std::nullopt;
    Proof proof;
    proof.finite = read["finite"];
    for (const json& box : read["open"]) proof.open.push_back(box_of(box));
    proof.open_count = read["open_count"];
    proof.open_tested = read["open_tested"];
    proof.open_not_finite = read["open_not_finite"];
    if (!read["over"].is_null()) proof.over = box_of(read["over"]);
    proof.refused = read["refused"];
    proof.floor = read["floor"];
    proof.ieee = bound_of(read["ieee"]);
    proof.vulkan = bound_of(read["vulkan"]);
    proof.boxes = read["boxes"];
    return proof;
}

// ---- one function

NamedBox named(const Subject& subject, const Box& box)
{
    NamedBox result;
    for (std::size_t i = 0; i < box.size(); ++i)
        result.sides.emplace_back(subject.names[i], box[i]);
    return result;
}

/// The part that holds for all outputs of a function.
void narrow(NamedBox& box, const NamedBox& other)
{
    for (const auto& [name, side] : other.sides) {
        const auto at = std::ranges::find_if(
            box.sides, [&name = name](const auto& known) { return known.first == name; });
        if (at == box.sides.end())
            box.sides.emplace_back(name, side);
        else
            at->second = evaluate::common(at->second, side);
    }
}

class FunctionProof {
public:
    FunctionProof(std::vector<Subject> subjects, std::size_t budget)
        : subjects_{std::move(subjects)}, budget_{budget}
    {
    }

    Proof prove()
    {
        out_.finite = true;
        for (Subject& subject : subjects_) {
            out_.floor = subject.floor;
            if (subject.precision == Precision::float32)
                prove_float(subject);
            else if (!prove_half(subject))
                break;
        }
        if (out_.refused.empty())
            for (Subject& subject : subjects_) {
                if (out_.over) restrict(subject);
                bound(subject);
            }
        return std::move(out_);
    }

private:
    std::size_t share(std::size_t part) const { return std::max<std::size_t>(budget_ / part, 1); }

    void prove_float(const Subject& subject)
    {
        const Finite proof = prove_finite(subject, subject.box, share(8));
        out_.boxes += proof.boxes;
        if (proof.open.empty()) return;
        out_.finite = false;
        out_.open_count += proof.open.size();
        for (const Box& box : proof.open) {
            if (out_.open.size() < most_open_told) out_.open.push_back(named(subject, box));
            test(subject, box, std::max<std::size_t>(65536 / proof.open.size(), 16));
        }
    }

    bool prove_half(const Subject& subject)
    {
        const auto part = finite_part(subject, share(512));
        if (!part) {
            out_.finite = false;
            out_.over.reset();
            out_.refused = first_hazard(subject, subject.box);
            for (ErrorBound* bound : {&out_.ieee, &out_.vulkan})
                bound->absolute = bound->relative = evaluate::infinity;
            test(subject, subject.box, 65536);
            return false;
        }
        if (!out_.over) out_.over.emplace();
        narrow(*out_.over, named(subject, *part));
        return true;
    }

    /// Points of an open box.
    void test(const Subject& subject, const Box& box, std::size_t count)
    {
        std::vector<Observed> values;
        evaluate_points(subject, points_in(subject, box, count, out_.open_tested), values);
        out_.open_tested += count;
        for (const Observed& value : values)
            out_.open_not_finite += std::isfinite(value.computed) ? 0 : 1;
    }

    void restrict(Subject& subject) const
    {
        for (std::size_t i = 0; i < subject.box.size(); ++i)
            for (const auto& [name, side] : out_.over->sides)
                if (name == subject.names[i]) subject.box[i] = side;
    }

    /// The larger of what is known so far and of this output.
    void observe(const Subject& subject, const Worst& worst, double& most)
    {
        const Point* const point = worst.point();
        if (point == nullptr) return;
        const double error =
            std::isfinite(worst.error())
                ? error_of(subject, confirm_point(subject, *point), worst.measure())
                : worst.error();
        if (error <= most) return;
        most = error;
        if (worst.measure() != Measure::jump) out_.ieee.at = describe(subject, *point);
    }

    void bound(const Subject& subject)
    {
        Worst absolute{subject, Measure::absolute};
        Worst relative{subject, Measure::relative};
        Worst jumps{subject, Measure::jump};
        explore(subject, {&absolute, &relative, &jumps}, 0);

        Bound by_absolute{subject, Machine::kernels, Measure::absolute, absolute};
        Bound by_relative{subject, Machine::kernels, Measure::relative, relative};
        by_absolute.refine(share(16), sharp);
        by_relative.refine(share(16), sharp);
        // One good measure is enough: the one that is closer goes on, then the other; and if that
        // does not do, worse points are looked for.
        std::array<Bound*, 2> measures{&by_absolute, &by_relative};
        std::ranges::stable_sort(measures, {}, &Bound::ratio);
        const auto is_far = [&measures] {
            const double ratio = std::min(measures[0]->ratio(), measures[1]->ratio());
            return ratio > wanted && ratio < ErrorBound::useless;
        };
        for (Bound* const measure : measures)
            if (is_far()) measure->refine(share(1), wanted);
        for (std::uint64_t round = 1; round <= most_rounds && is_far(); ++round)
            explore(subject, {&absolute, &relative, &jumps}, round);
        Bound by_jump{subject, Machine::kernels, Measure::jump, jumps};
        by_jump.refine(share(16), sharp);
        take(out_.ieee, by_absolute, by_relative, by_jump);
        observe(subject, relative, out_.ieee.observed_relative);
        observe(subject, absolute, out_.ieee.observed_absolute);
        observe(subject, jumps, out_.ieee.observed_jump);

        Bound any_absolute{subject, Machine::vulkan, Measure::absolute, absolute};
        Bound any_relative{subject, Machine::vulkan, Measure::relative, relative};
        Bound any_jump{subject, Machine::vulkan, Measure::jump, jumps};
        any_absolute.refine(share(32), sharp_vulkan);
        any_relative.refine(share(32), sharp_vulkan);
        any_jump.refine(share(32), sharp_vulkan);
        take(out_.vulkan, any_absolute, any_relative, any_jump);
        out_.vulkan.observed_absolute = out_.ieee.observed_absolute;
        out_.vulkan.observed_relative = out_.ieee.observed_relative;
        out_.vulkan.observed_jump = out_.ieee.observed_jump;
        out_.vulkan.at = out_.ieee.at;
    }

    void take(ErrorBound& bound, const Bound& absolute, const Bound& relative, const Bound& jump)
    {
        bound.absolute = std::max(bound.absolute, absolute.value());
        bound.relative = std::max(bound.relative, relative.value());
        bound.jump = std::max(bound.jump, jump.value());
        out_.boxes += absolute.boxes() + relative.boxes() + jump.boxes();
    }

    std::vector<Subject> subjects_;
    std::size_t budget_;
    Proof out_;
};

std::string key_of(const std::vector<Subject>& subjects, std::size_t budget)
{
    std::string key = fmt::format("proof 3 {} {}\n", budget,
                                  subjects.empty() ? 0 : static_cast<int>(subjects[0].precision));
    for (const Subject& subject : subjects) {
        key += dump(subject.steps) + dump(subject.operations);
        for (std::size_t i = 0; i < subject.box.size(); ++i)
            key += fmt::format("{} {} {} {}\n", subject.names[i], subject.box[i].low,
                               subject.box[i].high, subject.whole[i]);
    }
    return key;
}

/// The proofs of some functions in all precisions: by function, then precision.
std::vector<Proof> prove(const ir::Module& module, const std::vector<ir::Function>& functions,
                         const ProofOptions& options, const Store& store)
{
    const std::size_t ways = options.precisions.size();
    std::vector<Proof> out(functions.size() * ways);
    std::vector<std::vector<Subject>> all(out.size());
    std::vector<std::string> keys(out.size());
    for_each_task(out.size(), options.jobs, [&](std::size_t i) {
        all[i] = subjects(module, functions[i / ways], options.precisions[i % ways]);
        keys[i] = key_of(all[i], options.boxes);
    });
    // Functions of the same content have one proof. The longest first: what is left at the end
    // keeps one thread busy, not all waiting.
    std::map<std::string_view, std::vector<std::size_t>> same;
    for (std::size_t i = 0; i < out.size(); ++i) same[keys[i]].push_back(i);
    std::vector<std::vector<std::size_t>> tasks;
    for (auto& [key, indices] : same) tasks.push_back(std::move(indices));
    std::ranges::stable_sort(tasks, [&](const auto& a, const auto& b) {
        return keys[a.front()].size() > keys[b.front()].size();
    });
    std::mutex mutex;
    Progress progress{0, out.size(), {}};
    for_each_task(tasks.size(), options.jobs, [&](std::size_t task) {
        const auto start = std::chrono::steady_clock::now();
        const std::size_t first = tasks[task].front();
        const auto make = [&] { return FunctionProof{all[first], options.boxes}.prove(); };
        std::optional<Proof> proof =
            proof_of(kept(store, keys[first], [&] { return text_of(make()); }));
        if (!proof) proof = make();
        const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
        proof->seconds = seconds.count();
        const std::lock_guard lock{mutex};
        for (const std::size_t i : tasks[task]) {
            proof->function = functions[i / ways].name;
            proof->precision = options.precisions[i % ways];
            out[i] = *proof;
        }
        progress.done += tasks[task].size();
        progress.what = functions[first / ways].name;
        if (options.progress) options.progress(progress);
    });
    return out;
}

/// A geometry field as a function of the vectors.
ir::Function field_function(ir::GeometryField field)
{
    const ir::FieldFacts& known = ir::facts(field);
    ir::Function function;
    function.name = known.name;
    function.kind = ir::Function::Kind::term;
    function.quantity = ir::Quantity::number;
    function.range = {known.low, known.high};
    const auto vector = [&](ir::GeometryField which) {
        const ir::FieldFacts& of = ir::facts(which);
        ir::Input input;
        input.name = of.name;
        input.type = of.type;
        input.quantity = ir::Quantity::direction;
        input.range = {-1, 1};
        input.origin = ir::Origin::geometry;
        input.which = static_cast<std::uint32_t>(which);
        function.inputs.push_back(std::move(input));
        return function.graph.input(static_cast<std::uint32_t>(function.inputs.size() - 1),
                                    of.type);
    };
    ir::Frame frame;
    frame.l = vector(ir::GeometryField::l);
    frame.v = vector(ir::GeometryField::v);
    frame.n = vector(ir::GeometryField::n);
    if (ir::needs_tangents(field)) {
        frame.x = vector(ir::GeometryField::x);
        frame.y = vector(ir::GeometryField::y);
    }
    function.result = ir::expand(function.graph, field, frame);
    return function;
}

}  // namespace

std::string describe(const NamedBox& box)
{
    std::string text;
    for (const auto& [name, side] : box.sides)
        text += side.low == side.high
                    ? fmt::format("{}{} = {:.6g}", text.empty() ? "" : ", ", name, side.low)
                    : fmt::format("{}{} in [{:.6g}, {:.6g}]", text.empty() ? "" : ", ", name,
                                  side.low, side.high);
    return text;
}

double ErrorBound::ratio() const
{
    const auto of = [](double bound, double observed) {
        if (bound == 0) return 1.0;
        return observed > 0 ? bound / observed : evaluate::infinity;
    };
    return std::min(of(absolute, observed_absolute), of(relative, observed_relative));
}

std::vector<Proof> proofs(const ir::Module& module, const ProofOptions& options, const Store& store)
{
    std::vector<ir::Function> functions;
    for (const ir::FunctionId id : checked_functions(module))
        if (module[id].kind != ir::Function::Kind::storage) functions.push_back(module[id]);
    std::ranges::stable_sort(functions, {}, &ir::Function::name);
    return prove(module, functions, options, store);
}

std::vector<Proof> proofs_of(const ir::Module& module, const std::vector<ir::FunctionId>& functions,
                             const ProofOptions& options, const Store& store)
{
    std::vector<ir::Function> chosen;
    for (const ir::FunctionId id : functions) chosen.push_back(module[id]);
    return prove(module, chosen, options, store);
}

std::vector<Proof> field_proofs(const ir::Module& module, const ProofOptions& options,
                                const Store& store)
{
    std::vector<ir::GeometryField> fields;
    for (const ir::FunctionId id : checked_functions(module))
        for (const ir::Input& input : module[id].inputs)
            if (input.origin == ir::Origin::geometry)
                fields.push_back(static_cast<ir::GeometryField>(input.which));
    std::ranges::sort(fields);
    fields.erase(std::unique(fields.begin(), fields.end()), fields.end());
    std::vector<ir::Function> functions;
    for (const ir::GeometryField field : fields)
        if (ir::facts(field).type == ir::Type::scalar) functions.push_back(field_function(field));
    return prove(module, functions, options, store);
}

}  // namespace lobe::analyze
