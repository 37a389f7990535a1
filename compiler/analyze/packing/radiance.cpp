#include "analyze/packing/radiance.h"

#include "analyze/packing/radiance_search.h"
#include "analyze/tasks.h"

#include <fmt/format.h>

#include <algorithm>

namespace lobe::analyze {
namespace {

constexpr std::size_t chunk = 1024;
constexpr std::size_t seeds_alone = 16;
constexpr std::size_t seeds_whole = 48;
constexpr int rounds = 96;

/// One thing to measure: some coordinates stored, the others as they are.
struct Question {
    StoredAs stored;
    std::vector<Peak> best;          ///< per chunk, its worst point
    std::vector<double> anywhere;    ///< errors of the points that are uniform over the box
    std::vector<double> codes = {};  ///< the same on a display, if that is asked for
};

/// Evaluates all points for all questions at once: the exact radiance is the same for all.
void survey(const RadianceBox& box, const StoredAs& all, std::vector<Question>& questions,
            const RadianceOptions& options)
{
    const std::size_t chunks = std::max<std::size_t>(1, (options.points + chunk - 1) / chunk);
    for (Question& question : questions) {
        question.best.resize(chunks);
        question.anywhere.resize(chunks * chunk / 2);
    }
    if (options.codes) questions.back().codes.resize(chunks * chunk / 2);
    for_each_task(chunks, options.jobs, [&](std::size_t task) {
        RadianceMeter meter{box, chunk};
        for (std::size_t row = 0; row < chunk; ++row)
            place_point(box, all, task * chunk + row, meter, row);
        meter.light();
        for (Question& question : questions) {
            const std::vector<double>& errors = meter.compare(question.stored);
            for (std::size_t row = 0; row < chunk; row += 2)
                question.anywhere[(task * chunk + row) / 2] = errors[row];
            if (!question.codes.empty())
                for (std::size_t row = 0; row < chunk; row += 2)
                    question.codes[(task * chunk + row) / 2] = meter.codes(row);
            const auto worst = std::ranges::max_element(errors);
            question.best[task] = {*worst,
                                   meter.point(static_cast<std::size_t>(worst - errors.begin()))};
        }
    });
}

void keep_worst(std::vector<Peak>& peaks, std::size_t count)
{
    std::ranges::stable_sort(peaks, [](const Peak& a, const Peak& b) { return a.error > b.error; });
    if (peaks.size() > count) peaks.resize(count);
}

/// Climbs from every peak of every question, then twice more from what is worst of each.
void ascend(const RadianceBox& box, std::vector<Question*> questions, unsigned jobs)
{
    for (const int pass : {0, 1, 2}) {
        std::vector<std::pair<Question*, std::size_t>> starts;
        for (Question* question : questions) {
            if (pass > 0) keep_worst(question->best, 4);
            for (std::size_t i = 0; i < question->best.size(); ++i)
                starts.emplace_back(question, i);
        }
        for_each_task(starts.size(), jobs, [&](std::size_t task) {
            const auto [question, i] = starts[task];
            Peak& peak = question->best[i];
            const auto key = static_cast<std::uint64_t>(pass) << 32 | i;
            const Peak found = climb(box, question->stored, peak.point, rounds, key);
            if (found.error > peak.error) peak = found;
        });
    }
    for (Question* question : questions) keep_worst(question->best, 1);
}

/// The value that a share of all values does not exceed.
double quantile(std::vector<double>& values, double share)
{
    const auto at = static_cast<std::size_t>(share * static_cast<double>(values.size() - 1));
    const auto nth = values.begin() + static_cast<std::ptrdiff_t>(at);
    std::nth_element(values.begin(), nth, values.end());
    return *nth;
}

RadianceError report(const RadianceBox& box, Question& question)
{
    RadianceError out;
    out.typical = quantile(question.anywhere, 0.5);
    out.often = quantile(question.anywhere, 0.95);
    if (!question.codes.empty()) {
        out.codes = std::ranges::max(question.codes);
        out.often_codes = quantile(question.codes, 0.95);
    }
    RadianceMeter meter{box, 1};
    const std::vector<float>& point = question.best.front().point;
    meter.set(0, point);
    meter.light();
    meter.compare(question.stored);
    const RadianceMeter::Detail detail = meter.detail(0);
    out.worst = detail.error;
    out.witness.exact = detail.exact;
    out.witness.packed = detail.packed;
    for (std::size_t i = 0; i < box.width(); ++i) {
        const std::string& name = box.coordinates[i].name;
        out.witness.inputs.emplace_back(name, point[i]);
        if (const Steps* steps = question.stored[i])
            out.witness.stored.emplace_back(name, steps->stored(point[i]));
    }
    return out;
}

}  // namespace

PackingErrors packing_errors(const ir::Module& module, const ir::Packing& packing,
                             const RadianceOptions& options)
{
    const RadianceBox box = radiance_box(module, packing);
    std::vector<Steps> steps;
    for (const ir::Field& field : packing.fields) steps.push_back(steps_of(module, field));

    PackingErrors out;
    std::vector<Question> questions;
    const auto ask = [&](std::optional<std::uint32_t> parameter) {
        StoredAs stored(box.width(), nullptr);
        for (std::size_t i = 0; i < box.width(); ++i) {
            const auto field = box.coordinates[i].field;
            if (field && (!parameter || packing.fields[*field].parameter == *parameter))
                stored[i] = &steps[*field];
        }
        questions.push_back({std::move(stored), {}, {}});
    };
    for (std::uint32_t p = 0; p < module.parameters.size(); ++p) {
        if (std::ranges::none_of(packing.fields,
                                 [p](const ir::Field& field) { return field.parameter == p; }))
            continue;
        out.parameters.push_back({p, {}});
        ask(p);
    }
    ask(std::nullopt);

    survey(box, questions.back().stored, questions, options);
    out.points = questions.back().anywhere.size() * 2;
    std::vector<Question*> alone;
    for (Question& question : questions) {
        keep_worst(question.best, &question == &questions.back() ? seeds_whole : seeds_alone);
        if (&question != &questions.back()) alone.push_back(&question);
    }
    ascend(box, alone, options.jobs);
    // What is worst for one parameter is a good place to look for what is worst for all.
    Question& whole = questions.back();
    for (const Question* question : alone) whole.best.push_back(question->best.front());
    ascend(box, {&whole}, options.jobs);

    for (std::size_t i = 0; i < alone.size(); ++i)
        out.parameters[i].error = report(box, questions[i]);
    out.whole = report(box, whole);
    return out;
}

namespace {

std::string percent(double error) { return fmt::format("{:.3g} %", error * 100); }

/// `l = (0.6, 0, 0.8), roughness = 0.5`. The frame is always the axes and left out.
std::string listed(const std::vector<std::pair<std::string, double>>& values)
{
    std::string text;
    std::string open;  // the vector whose components are being written
    for (const auto& [column, value] : values) {
        const std::string name = column.substr(0, column.find('.'));
        if (column != name && (name == "n" || name == "x" || name == "y")) continue;
        if (name == open) {
            text += fmt::format(", {:.6g}", value);
            continue;
        }
        if (!open.empty()) text += ")";
        open = column == name ? "" : name;
        text += fmt::format("{}{} = {}{:.6g}", text.empty() ? "" : ", ", name,
                            open.empty() ? "" : "(", value);
    }
    return open.empty() ? text : text + ")";
}

std::string stored_text(const RadianceWitness& witness)
{
    std::string text;
    for (const auto& [name, value] : witness.stored)
        for (const auto& [input, exact] : witness.inputs)
            if (input == name && exact != value)
                text += fmt::format("{}{} = {:.6g} becomes {:.6g}", text.empty() ? "" : ", ", name,
                                    exact, value);
    return text;
}

}  // namespace

Diagnostics unmet(const ir::Module& module, const ir::Packing& packing, const PackingErrors& errors)
{
    Diagnostics diagnostics;
    if (!packing.radiance_limit || errors.whole.worst < *packing.radiance_limit) return diagnostics;
    const RadianceWitness& witness = errors.whole.witness;
    std::vector<PackingErrors::OfParameter> ranked = errors.parameters;
    std::ranges::stable_sort(
        ranked, [](const auto& a, const auto& b) { return a.error.worst > b.error.worst; });
    std::string alone;
    for (const auto& [parameter, error] : ranked)
        alone += fmt::format("{}{} {}", alone.empty() ? "" : ", ",
                             module.parameters[parameter].name, percent(error.worst));
    diagnostics.report(
        {.code = Code::radiance_exceeded,
         .message = fmt::format("the packing of `{}` changes its radiance by up to {}",
                                packing.model.name, percent(errors.whole.worst)),
         .primary = {packing.radiance_span,
                     fmt::format("asks for less than {}", percent(*packing.radiance_limit))},
         .notes = {fmt::format("radiance {:.6g} becomes {:.6g} at {}", witness.exact,
                               witness.packed, listed(witness.inputs)),
                   "there, " + stored_text(witness), "each parameter alone: " + alone},
         .helps = {"give the first of these more bits, another code, or a narrower range with `in`",
                   "`lobec pack --suggest` searches for a layout"}});
    return diagnostics;
}

}  // namespace lobe::analyze
