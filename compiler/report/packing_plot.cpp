#include "report/packing_plot.h"

#include "report/markup.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace lobe::report {
namespace {

/// Both axes. Ticks of the errors are 1 and 3 times powers of 10.
struct Axes {
    int first = 0, last = 0;  ///< bits
    std::vector<double> ticks;

    bool is_empty() const { return ticks.size() < 2; }
    /// 0 at the lowest tick, 1 at the highest.
    double height(double error) const
    {
        const double low = std::log(ticks.front()), high = std::log(ticks.back());
        if (error <= ticks.front()) return 0;
        return std::min((std::log(error) - low) / (high - low), 1.0);
    }
};

double tick(int index)
{
    const int decade = static_cast<int>(std::floor(index / 2.0));
    return (index - 2 * decade == 0 ? 1.0 : 3.0) * std::pow(10.0, decade);
}

/// The index of the greatest tick that is not above an error.
int tick_below(double error)
{
    int index = 2 * static_cast<int>(std::floor(std::log10(error)));
    while (tick(index) > error) --index;
    while (tick(index + 1) <= error) ++index;
    return index;
}

Axes axes_of(const Plot& plot)
{
    constexpr int most_ticks = 12;  // six decades; what is below them is as good as 0
    Axes out;
    double least = 0, most = 0;
    bool any = false;
    for (const Plot::Series& series : plot.series)
        for (const auto& [bits, error] : series.points) {
            out.first = any ? std::min(out.first, bits) : bits;
            out.last = any ? std::max(out.last, bits) : bits;
            any = true;
            if (!std::isfinite(error) || error <= 0) continue;
            least = least == 0 ? error : std::min(least, error);
            most = std::max(most, error);
        }
    if (most == 0) return out;
    for (const Plot::Level& level : plot.levels)
        if (std::isfinite(level.error) && level.error > 0) {
            least = std::min(least, level.error);
            most = std::max(most, level.error);
        }
    const int below = tick_below(most);
    const int high = tick(below) < most ? below + 1 : below;
    const int low = std::min(tick_below(least), high - 1);
    for (int index = std::max(low, high - most_ticks); index <= high; ++index)
        out.ticks.push_back(tick(index));
    return out;
}

}  // namespace

Plot trade_plot(const Packed& packed)
{
    Plot out;
    out.title = "worst radiance error by bits";
    Plot::Series measured{"measured", '*', false, {}, 0}, predicted{"predicted", 'o', true, {}, 0};
    for (const analyze::TradePoint& point : packed.suggestion->trade) {
        measured.points.emplace_back(point.bits, point.measured);
        predicted.points.emplace_back(point.bits, point.predicted);
    }
    for (const ir::Field& field : packed.packing->fields) measured.chosen += field.bits;
    out.series = {measured, predicted};
    if (packed.limit) out.levels.push_back({"limit", *packed.limit});
    if (packed.suggestion->found)
        out.levels.push_back({"8 linear bits each", packed.suggestion->linear.whole.worst});
    return out;
}

Plot curve_plot(const analyze::Suggestion& suggestion)
{
    constexpr std::string_view marks = "abcdefghijklmnopqrstuvwxyz";
    Plot out;
    out.title = "worst radiance error of each parameter by its bits";
    for (std::size_t i = 0; i < suggestion.curves.size(); ++i) {
        const analyze::Curve& curve = suggestion.curves[i];
        Plot::Series series{suggestion.module.parameters[curve.parameter].name,
                            marks[i % marks.size()],
                            false,
                            {},
                            0};
        for (const analyze::CurvePoint& point : curve.points)
            series.points.emplace_back(point.bits, point.error);
        if (suggestion.found)
            for (const ir::Field& field : suggestion.module.packings.back().fields)
                if (field.parameter == curve.parameter) series.chosen = field.bits;
        out.series.push_back(std::move(series));
    }
    return out;
}

std::string plot_text(const Plot& plot, const Look& look)
{
    const Axes axes = axes_of(plot);
    if (axes.is_empty()) return {};
    constexpr std::size_t rows = 13, label = 10;
    const int width =
        (look.width > 0 ? std::min(look.width, 100) : 80) - static_cast<int>(label) - 4;
    const int step = std::clamp(width / std::max(axes.last - axes.first, 1), 1, 4);
    const auto column = [&](int bits) {
        return static_cast<std::size_t>(step * (bits - axes.first) + 1);
    };
    const auto row = [&](double error) {
        return rows - 1 - static_cast<std::size_t>(std::lround(axes.height(error) * (rows - 1)));
    };

    std::vector<std::string> canvas(rows, std::string(column(axes.last) + 2, ' '));
    std::vector<std::string> labels(rows);
    for (const double at : axes.ticks) labels[row(at)] = percent(at);
    for (const Plot::Level& level : plot.levels) {
        std::string& line = canvas[row(level.error)];
        std::ranges::replace(line, ' ', '-');
        // At the right, where errors are small and the line is free.
        const std::string name = " " + level.name + " " + percent(level.error) + " ";
        if (name.size() + 2 > line.size())
            line += name;
        else
            line.replace(line.size() - name.size() - 1, name.size(), name);
    }
    for (auto series = plot.series.rbegin(); series != plot.series.rend(); ++series)
        for (const auto& [bits, error] : series->points)
            canvas[row(error)][column(bits)] = series->mark;

    std::string out = styled(plot.title, Style::strong, look.color) + "\n";
    for (std::size_t i = 0; i < rows; ++i) {
        std::string line = fmt::format("{:>{}} |{}", labels[i], label, canvas[i]);
        line.erase(line.find_last_not_of(' ') + 1);
        out += line + "\n";
    }
    out += std::string(label + 1, ' ') + "+" + std::string(column(axes.last) + 2, '-') + "\n";
    int unit = 1;
    while (unit * step < 4) unit *= 2;
    std::string numbers(label + 2, ' ');
    for (int bits = axes.first; bits <= axes.last; ++bits) {
        if (bits % unit != 0) continue;
        const std::string number = std::to_string(bits);
        numbers.resize(label + 2 + column(bits) - (number.size() > 1 ? 1 : 0), ' ');
        numbers += number;
    }
    out += numbers + " bits\n";
    std::string legend(label + 2, ' ');
    for (const Plot::Series& series : plot.series)
        legend += fmt::format(" {} {} ", series.mark, series.name);
    legend.erase(legend.find_last_not_of(' ') + 1);
    return out + legend + "\n";
}

std::string plot_svg(const Plot& plot)
{
    const Axes axes = axes_of(plot);
    if (axes.is_empty()) return {};
    constexpr double left = 70, top = 14, width = 560, height = 300, bottom = 40, right = 300;
    const int span = std::max(axes.last - axes.first, 1);
    const auto x = [&](int bits) { return left + width * (bits - axes.first) / span; };
    const auto y = [&](double error) { return top + height * (1 - axes.height(error)); };

    std::string out =
        fmt::format("<svg class=\"plot\" viewBox=\"0 0 {} {}\" role=\"img\" "
                    "aria-label=\"{}\">\n",
                    left + width + right, top + height + bottom, escaped_xml(plot.title));
    for (const double at : axes.ticks)
        out += fmt::format("<line class=\"grid\" x1=\"{0:.1f}\" x2=\"{1:.1f}\" y1=\"{2:.1f}\" "
                           "y2=\"{2:.1f}\"/><text class=\"n\" x=\"{3:.1f}\" y=\"{4:.1f}\">{5}"
                           "</text>\n",
                           left, left + width, y(at), left - 8, y(at) + 4, percent(at));
    for (int bits = axes.first; bits <= axes.last; ++bits)
        if (span <= 20 || bits % 4 == 0)
            out += fmt::format("<text class=\"m\" x=\"{:.1f}\" y=\"{:.1f}\">{}</text>\n", x(bits),
                               top + height + 18, bits);
    out += fmt::format("<text class=\"m\" x=\"{:.1f}\" y=\"{:.1f}\">bits</text>\n",
                       left + width / 2, top + height + 35);
    for (const Plot::Level& level : plot.levels)
        out += fmt::format("<line class=\"level\" x1=\"{0:.1f}\" x2=\"{1:.1f}\" y1=\"{2:.1f}\" "
                           "y2=\"{2:.1f}\"/><text x=\"{3:.1f}\" y=\"{4:.1f}\">{5} {6}</text>\n",
                           left, left + width, y(level.error), left + width + 10,
                           y(level.error) + 4, escaped_xml(level.name), percent(level.error));
    constexpr std::size_t hues = 8;
    double legend = top + 8;
    for (std::size_t i = 0; i < plot.series.size(); ++i) {
        const Plot::Series& series = plot.series[i];
        const std::string classes =
            fmt::format("s{}{}", i % hues, series.dashed || i >= hues ? " dashed" : "");
        std::string points;
        for (const auto& [bits, error] : series.points)
            points += fmt::format("{}{:.1f},{:.1f}", points.empty() ? "" : " ", x(bits), y(error));
        out += fmt::format("<g class=\"{}\"><polyline points=\"{}\"/>", classes, points);
        for (const auto& [bits, error] : series.points)
            out += fmt::format(
                "<circle class=\"{}\" cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"{}\"><title>{}: "
                "{} at {} bits</title></circle>",
                bits == series.chosen ? "chosen" : "", x(bits), y(error),
                bits == series.chosen ? 5 : 2.5, escaped_xml(series.name), percent(error), bits);
        // Levels name themselves at their height; the legend stands further right.
        const double at = left + width + (plot.levels.empty() ? 10 : 210);
        out += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\">{}</text></g>\n", at, legend,
                           escaped_xml(series.name));
        legend += 18;
    }
    return out + "</svg>\n";
}

}  // namespace lobe::report
