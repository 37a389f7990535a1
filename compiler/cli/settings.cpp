#include "cli/settings.h"

#include "optimize/specialize.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

namespace lobe::cli {
namespace {

std::optional<double> number_of(std::string_view text)
{
    double number = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (error != std::errc{} || end != text.data() + text.size() || !std::isfinite(number))
        return std::nullopt;
    return number;
}

std::optional<std::vector<double>> numbers_of(std::string_view text)
{
    std::vector<double> numbers;
    for (;;) {
        const auto comma = text.find(',');
        const auto number = number_of(text.substr(0, comma));
        if (!number) return std::nullopt;
        numbers.push_back(*number);
        if (comma == std::string_view::npos) return numbers;
        text.remove_prefix(comma + 1);
    }
}

std::string listed(const ir::Range& range)
{
    return fmt::format("[{}, {}]", range.low, range.high);
}

}  // namespace

std::vector<std::string> family_names()
{
    std::vector<std::string> names;
    for (const analyze::Family family : analyze::all_families)
        names.emplace_back(analyze::name(family));
    return names;
}

std::optional<double> positive_number(const std::string& text)
{
    const auto number = number_of(text);
    return number && *number > 0 ? number : std::nullopt;
}

std::optional<double> fraction_of(std::string text)
{
    if (!text.ends_with('%')) return positive_number(text);
    text.pop_back();
    while (text.ends_with(' ')) text.pop_back();
    const auto percent = positive_number(text);
    if (!percent) return std::nullopt;
    return *percent / 100;
}

std::string specialize(Program& program, const std::vector<std::string>& settings)
{
    optimize::Settings fixed;
    for (const std::string& setting : settings) {
        const auto equals = setting.find('=');
        const std::string name = setting.substr(0, equals);
        const auto values = equals == std::string::npos
                                ? std::nullopt
                                : numbers_of(std::string_view{setting}.substr(equals + 1));
        if (!values) return fmt::format("--set takes name=value or name=r,g,b; got `{}`", setting);
        std::vector<std::string> names;
        bool found = false;
        for (const ir::Module& module : program.modules)
            for (const ir::Parameter& parameter : module.parameters) {
                names.push_back(parameter.name);
                if (parameter.name != name) continue;
                found = true;
                if (values->size() != parameter.default_value.size())
                    return fmt::format("`{}` has {} components; got {}", name,
                                       parameter.default_value.size(), values->size());
                for (const double value : *values)
                    if (value < parameter.range.low || value > parameter.range.high)
                        return fmt::format("`{}` is in {}; got {}", name, listed(parameter.range),
                                           value);
            }
        if (!found) {
            const auto near = nearest(name, names);
            return fmt::format("no parameter `{}`{}", name,
                               near ? fmt::format("; did you mean `{}`?", *near) : "");
        }
        fixed[name] = *values;
    }
    if (!fixed.empty())
        for (ir::Module& module : program.modules) module = optimize::specialize(module, fixed);
    return {};
}

}  // namespace lobe::cli
