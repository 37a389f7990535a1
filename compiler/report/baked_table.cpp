#include "report/baked_table.h"

#include "analyze/environment/texture_file.h"
#include "report/markup.h"
#include "report/verification.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace lobe::report {
namespace {

using analyze::BakedTable;
using analyze::BakeError;
using analyze::Place;
using nlohmann::ordered_json;

std::string where(const BakedTable& table, const Place& at)
{
    std::string out;
    for (std::size_t i = 0; i < table.subject.axes.size(); ++i)
        out += fmt::format("{}{} = {}", i == 0 ? "" : ", ", table.subject.axes[i].name,
                           short_number(i == 0 ? at.x : at.y));
    return out;
}

ordered_json to_json(const BakeError& error, std::size_t axes)
{
    ordered_json at = ordered_json::array({json_number(error.at.x)});
    if (axes == 2) at.push_back(json_number(error.at.y));
    return {{"worst", json_number(error.worst)},
            {"root_mean_square", json_number(error.root_mean_square)},
            {"at", at}};
}

ordered_json to_json(const analyze::AnalyticFit& fit)
{
    return {{"x0", fit.x0},           {"x1", fit.x1},           {"decay", fit.decay},
            {"scale_a", fit.scale_a}, {"scale_0", fit.scale_0}, {"scale_1", fit.scale_1},
            {"bias_a", fit.bias_a},   {"bias_0", fit.bias_0},   {"bias_1", fit.bias_1}};
}

}  // namespace

std::string to_text(const BakedTable& table, const Look& look)
{
    std::string out = fmt::format("{}: {} x {} texels of {}, {} bytes; values by {}\n",
                                  table.subject.name, table.width(), table.height(),
                                  table.format.reads, grouped(table.bytes()), table.subject.how);
    for (std::size_t i = 0; i < table.subject.axes.size(); ++i) {
        const analyze::TableAxis& axis = table.subject.axes[i];
        out += fmt::format("  {} {} in [{}, {}]: {}\n", i == 0 ? "across" : "down  ", axis.name,
                           axis.low, axis.high, analyze::address_of(axis, i == 0 ? "u" : "v"));
    }
    Table rows;
    rows.columns = {{""},
                    {"storage", true},
                    {"interpolation", true},
                    {"together", true},
                    {"root mean square", true},
                    {"worst at"}};
    for (const analyze::BakedComponent& component : table.components)
        rows.rows.push_back({{component.name},
                             {short_number(component.storage.worst)},
                             {short_number(component.interpolation.worst)},
                             {short_number(component.together.worst), Style::strong},
                             {short_number(component.together.root_mean_square)},
                             {where(table, component.together.at)}});
    return out + render(rows, look) +
           fmt::format("absolute errors, between texels at {} points\n", grouped(table.points));
}

std::string to_json(const BakedTable& table)
{
    const std::size_t axes = table.subject.axes.size();
    ordered_json out{{"name", table.subject.name},
                     {"values_by", table.subject.how},
                     {"width", table.width()},
                     {"height", table.height()},
                     {"format", table.format.reads},
                     {"bytes", table.bytes()},
                     {"axes", ordered_json::array()},
                     {"points", table.points},
                     {"components", ordered_json::array()}};
    for (const analyze::TableAxis& axis : table.subject.axes)
        out["axes"].push_back(
            {{"name", axis.name},
             {"low", axis.low},
             {"high", axis.high},
             {"texels", axis.places == analyze::TexelPlaces::ends ? "ends" : "centers"},
             {"scale", axis.scale()},
             {"offset", axis.offset()}});
    for (const analyze::BakedComponent& component : table.components)
        out["components"].push_back({{"name", component.name},
                                     {"storage", to_json(component.storage, axes)},
                                     {"interpolation", to_json(component.interpolation, axes)},
                                     {"together", to_json(component.together, axes)}});
    return out.dump(2) + '\n';
}

std::string to_text(const std::string& subject, std::span<const NamedFit> fits, const Look& look)
{
    Table rows;
    rows.columns = {{fmt::format("fits of {}", subject)},
                    {"scale", true},
                    {"bias", true},
                    {"reflected", true},
                    {"root mean square", true}};
    std::string bodies;
    for (const NamedFit& each : fits) {
        rows.rows.push_back({{each.name},
                             {short_number(each.error.scale)},
                             {short_number(each.error.bias)},
                             {short_number(each.error.reflected), Style::strong},
                             {short_number(each.error.root_mean_square)}});
        bodies += fmt::format("\n{}\n{}", each.name, analyze::body_of(each.fit));
    }
    return render(rows, look) + "greatest absolute errors; reflected: for the worst f0\n" + bodies;
}

std::string to_json(const std::string& subject, std::span<const NamedFit> fits)
{
    ordered_json out{{"name", subject}, {"fits", ordered_json::array()}};
    for (const NamedFit& each : fits)
        out["fits"].push_back({{"name", each.name},
                               {"constants", to_json(each.fit)},
                               {"error",
                                {{"scale", json_number(each.error.scale)},
                                 {"bias", json_number(each.error.bias)},
                                 {"reflected", json_number(each.error.reflected)},
                                 {"root_mean_square", json_number(each.error.root_mean_square)}}}});
    return out.dump(2) + '\n';
}

}  // namespace lobe::report
