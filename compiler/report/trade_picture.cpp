// The scatter of a trade, panel by panel. Error stands on a logarithmic axis that all panels share;
// cycles on one of each panel's own, since families count them differently.
#include "emit/template.h"
#include "report/markup.h"
#include "report/pareto_page.h"
#include "report/verification.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

namespace lobe::report {
namespace {

using analyze::Candidate;
using analyze::Family;
using analyze::Trade;

constexpr double panel_width = 250, panel_height = 190;
constexpr double left = 62, top = 42, between = 46, below = 62, right = 14;
constexpr int columns = 3;

/// Decades; what errs less than the lowest stands on it, as what does not err at all does, and what
/// errs more than the highest stands on that.
struct ErrorAxis {
    int low = 0;
    int high = 0;

    /// 0 at the lowest decade, 1 at the highest.
    double height(double error) const
    {
        if (!(error > std::pow(10, low))) return 0;
        return std::min((std::log10(error) - low) / (high - low), 1.0);
    }
};

double cost_of(const Trade& trade, const Candidate& candidate, Family family)
{
    const analyze::Cost& cost = trade.cost_of(candidate);
    return cost.families.contains(family) ? issue_on(cost, family)
                                          : std::numeric_limits<double>::quiet_NaN();
}

bool is_on_frontier(const Candidate& candidate, Family family)
{
    const auto found = candidate.standing.find(family);
    return found != candidate.standing.end() && found->second.on_frontier;
}

/// Of the frontiers: what is worse than all of them needs no room.
ErrorAxis axis_of(const Trade& trade)
{
    constexpr int most = 10;  // decades; float's own rounding is seven below 1
    ErrorAxis axis{0, -100};
    for (const Candidate& candidate : trade.candidates) {
        const double error = trade.error_of(candidate);
        if (!std::isfinite(error) || error <= 0) continue;
        if (!candidate.selectable || std::ranges::none_of(candidate.standing, [](const auto& at) {
                return at.second.on_frontier;
            }))
            continue;
        axis.low = std::min(axis.low, static_cast<int>(std::floor(std::log10(error))));
        axis.high = std::max(axis.high, static_cast<int>(std::ceil(std::log10(error))));
    }
    axis.high = std::max(axis.high, axis.low + 1);
    axis.low = std::max(axis.low, axis.high - most);
    return axis;
}

/// A step of 1, 2 or 5 times a power of ten that divides the axis into at most six.
double step_of(double most)
{
    for (double decade = 1;; decade *= 10)
        for (const double digit : {1.0, 2.0, 5.0})
            if (most / (digit * decade) <= 6) return digit * decade;
}

std::string kind_of(const Candidate& candidate)
{
    std::string kind = candidate.spelling == optimize::Spelling::naive ? "naive"
                       : candidate.found                               ? "found"
                       : candidate.choice.empty()                      ? "definition"
                                                                       : "written";
    if (!candidate.selectable) kind += " shown";
    return kind;
}

/// A circle for float, a square for half, a diamond for packed half.
std::string mark(analyze::Format format, double x, double y)
{
    switch (format) {
    case analyze::Format::float32:
        return fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"4\">", x, y);
    case analyze::Format::float16:
        return fmt::format("<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"7\" height=\"7\">", x - 3.5,
                           y - 3.5);
    case analyze::Format::packed16: break;
    }
    return fmt::format("<path d=\"M{:.1f} {:.1f}l5 5-5 5-5-5z\">", x, y - 5);
}

std::string_view closing(analyze::Format format)
{
    switch (format) {
    case analyze::Format::float32: return "</circle>";
    case analyze::Format::float16: return "</rect>";
    case analyze::Format::packed16: break;
    }
    return "</path>";
}

std::string hover(const Trade& trade, std::size_t index, Family family)
{
    const Candidate& candidate = trade.candidates[index];
    const analyze::Cost& cost = trade.cost_of(candidate);
    const analyze::FamilyCost& at = cost.families.at(family);
    std::string text = fmt::format(
        "{}: {}\n{} issue cycles ({} vector, {} transcendental), {} registers\nworst error {}: "
        "model {}, rounding {}; 99 % of points below {}; {} of 255 codes",
        index + 1, analyze::describe(candidate), short_number(at.issue), short_number(at.valu),
        short_number(at.transcendental), at.vgprs, short_number(candidate.total.scaled),
        short_number(candidate.model.scaled), short_number(candidate.rounding.scaled),
        short_number(candidate.total.often), short_number(candidate.total.codes));
    if (candidate.total.not_finite > 0)
        text += fmt::format("\nnot a number at {} of {} points",
                            grouped(candidate.total.not_finite), grouped(candidate.total.points));
    if (const auto found = candidate.standing.find(family); found != candidate.standing.end())
        if (const auto by = found->second.dominated_by)
            text += fmt::format("\ndominated by {}: {}", *by + 1,
                                analyze::describe(trade.candidates[*by]));
    return text;
}

class Panel {
public:
    Panel(const Trade& trade, Family family, const ErrorAxis& axis, double x, double y)
        : trade_{trade}, family_{family}, axis_{axis}, x_{x}, y_{y}
    {
        least_ = std::numeric_limits<double>::infinity();
        for (const Candidate& candidate : trade.candidates)
            if (const double cost = cost_of(trade, candidate, family); std::isfinite(cost)) {
                most_ = std::max(most_, cost);
                least_ = std::min(least_, cost);
            }
        // From 0, unless half of the axis were empty.
        if (least_ < most_ / 2) least_ = 0;
        step_ = step_of(std::max(most_ - least_, 1.0));
        least_ = step_ * std::floor(least_ / step_);
        most_ = step_ * std::ceil(std::max(most_, least_ + 1.0) / step_);
    }

    std::string draw() const
    {
        std::string out = fmt::format("<text class=\"name\" x=\"{:.1f}\" y=\"{:.1f}\">{}</text>\n",
                                      x_, y_ - 22, escaped_xml(analyze::title(family_)));
        for (int decade = axis_.low; decade <= axis_.high; ++decade)
            out += fmt::format("<line class=\"grid\" x1=\"{0:.1f}\" x2=\"{1:.1f}\" y1=\"{2:.1f}\" "
                               "y2=\"{2:.1f}\"/><text class=\"n\" x=\"{3:.1f}\" y=\"{4:.1f}\">"
                               "{5}</text>\n",
                               x_, x_ + panel_width, row(std::pow(10, decade)), x_ - 6,
                               row(std::pow(10, decade)) + 4, percent_of(decade));
        for (double cycles = least_; cycles <= most_; cycles += step_)
            out += fmt::format("<text class=\"m\" x=\"{:.1f}\" y=\"{:.1f}\">{:.0f}</text>\n",
                               column(cycles), y_ + panel_height + 16, cycles);
        out += fmt::format("<text class=\"m\" x=\"{:.1f}\" y=\"{:.1f}\">issue cycles</text>\n",
                           x_ + panel_width / 2, y_ + panel_height + 31);
        return out + staircase() + points();
    }

private:
    /// `1 %`, `1e-5 %`
    static std::string percent_of(int decade)
    {
        const int percent = decade + 2;
        if (percent >= -2 && percent <= 4) return fmt::format("{:g} %", std::pow(10, percent));
        return fmt::format("1e{} %", percent);
    }

    double column(double cycles) const
    {
        return x_ + panel_width * (cycles - least_) / (most_ - least_);
    }
    double row(double error) const { return y_ + panel_height * (1 - axis_.height(error)); }

    /// Of what a build can emit, cheapest first.
    std::vector<std::size_t> frontier() const
    {
        std::vector<std::size_t> out;
        for (std::size_t i = 0; i < trade_.candidates.size(); ++i)
            if (trade_.candidates[i].selectable && is_on_frontier(trade_.candidates[i], family_))
                out.push_back(i);
        std::ranges::stable_sort(out, {}, [this](std::size_t i) {
            return cost_of(trade_, trade_.candidates[i], family_);
        });
        return out;
    }

    std::string staircase() const
    {
        std::string path;
        for (const std::size_t i : frontier()) {
            const double x = column(cost_of(trade_, trade_.candidates[i], family_));
            const double y = row(trade_.error_of(trade_.candidates[i]));
            // From the top edge down to the cheapest, then along and down from one to the next.
            path += fmt::format("{}{:.1f}{}V{:.1f}", path.empty() ? "M" : "H", x,
                                path.empty() ? fmt::format(" {:.1f}", y_) : "", y);
        }
        if (path.empty()) return {};
        return fmt::format("<path class=\"frontier\" d=\"{}H{:.1f}\"/>\n", path, x_ + panel_width);
    }

    /// Dominated ones first, so that the frontier lies on top.
    std::string points() const
    {
        std::string back, front;
        for (std::size_t i = 0; i < trade_.candidates.size(); ++i) {
            const Candidate& candidate = trade_.candidates[i];
            const double cost = cost_of(trade_, candidate, family_);
            if (!std::isfinite(cost)) continue;
            const bool on_frontier = is_on_frontier(candidate, family_);
            const double x = column(cost), y = row(trade_.error_of(candidate));
            std::string& out = on_frontier ? front : back;
            out += fmt::format("<g class=\"{}{}\">{}<title>{}</title>{}", kind_of(candidate),
                               on_frontier ? "" : " dominated", mark(candidate.format, x, y),
                               escaped_xml(hover(trade_, i, family_)), closing(candidate.format));
            out += "</g>\n";
        }
        return back + front + labels();
    }

    /// Numbers of the frontier, most accurate first; one that would lie on another is left out.
    std::string labels() const
    {
        constexpr double wide = 24, high = 12;
        std::vector<std::pair<double, double>> taken;
        std::string out;
        std::vector<std::size_t> order = frontier();
        std::ranges::reverse(order);
        for (const std::size_t i : order) {
            const double x = column(cost_of(trade_, trade_.candidates[i], family_)) + 6;
            const double y = row(trade_.error_of(trade_.candidates[i])) - 5;
            if (std::ranges::any_of(taken, [&](const auto& at) {
                    return std::abs(at.first - x) < wide && std::abs(at.second - y) < high;
                }))
                continue;
            taken.emplace_back(x, y);
            out +=
                fmt::format("<text class=\"k\" x=\"{:.1f}\" y=\"{:.1f}\">{}</text>\n", x, y, i + 1);
        }
        return out;
    }

    const Trade& trade_;
    Family family_;
    ErrorAxis axis_;
    double x_;
    double y_;
    double least_ = 0;
    double most_ = 0;
    double step_ = 1;
};

std::string legend(const Trade& trade, double x, double y)
{
    struct Entry {
        std::string_view kind;
        analyze::Format format;
        std::string_view words;
    };
    constexpr analyze::Format circle = analyze::Format::float32;
    std::string out;
    for (const std::string& words :
         {fmt::format("error: {}", trade.whole_model ? "99 % of points stay below" : "the worst"),
          fmt::format("cost: issue cycles{}", trade.from_vectors ? " from vectors" : "")}) {
        out += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\">{}</text>\n", x - 4, y, words);
        y += 16;
    }
    y += 10;
    for (const Entry& entry : {Entry{"definition", circle, "the definition, spelled each way"},
                               Entry{"written", circle, "with forms that people wrote"},
                               Entry{"found", circle, "with forms the compiler found"},
                               Entry{"naive", circle, "as typed by hand, without guards"},
                               Entry{"definition", analyze::Format::float16, "half"},
                               Entry{"definition", analyze::Format::packed16, "packed half"},
                               Entry{"definition dominated", circle, "dominated by another"}}) {
        out += fmt::format("<g class=\"{}\">{}{}</g><text x=\"{:.1f}\" y=\"{:.1f}\">{}</text>\n",
                           entry.kind, mark(entry.format, x, y), closing(entry.format), x + 14,
                           y + 4, entry.words);
        y += 20;
    }
    return out;
}

struct Picture {
    std::string body;
    double width = 0;
    double height = 0;
};

Picture draw(const Trade& trade)
{
    std::set<Family> families;
    for (const Candidate& candidate : trade.candidates)
        for (const auto& cost : trade.cost_of(candidate).families) families.insert(cost.first);
    Picture out;
    if (families.empty()) return out;
    const ErrorAxis axis = axis_of(trade);
    const auto place = [](std::size_t panel) {
        const auto column = static_cast<double>(panel % columns);
        const auto line = static_cast<double>(panel / columns);
        return std::pair{left + column * (panel_width + left + right),
                         top + line * (panel_height + below + between / 2)};
    };
    std::size_t panels = 0;
    for (const Family family : families) {
        const auto [x, y] = place(panels++);
        out.body += Panel{trade, family, axis, x, y}.draw();
    }
    const auto [x, y] = place(panels);
    out.body += legend(trade, x, y + 4);
    out.width = columns * (left + panel_width + right);
    out.height = y + panel_height + below;
    return out;
}

}  // namespace

std::string trade_picture(const Trade& trade)
{
    const Picture picture = draw(trade);
    if (picture.body.empty()) return {};
    return fmt::format("<svg class=\"plot trade\" viewBox=\"0 0 {:.0f} {:.0f}\" role=\"img\" "
                       "aria-label=\"error against cost of {}\">\n{}</svg>",
                       picture.width, picture.height, escaped_xml(trade.name), picture.body);
}

std::string trade_svg(const Trade& trade)
{
    Picture picture = draw(trade);
    emit::Record record;
    record.texts["width"] = fmt::format("{:.0f}", picture.width);
    record.texts["height"] = fmt::format("{:.0f}", picture.height);
    record.texts["title"] = escaped_xml(fmt::format("error against cost of {}", trade.name));
    record.texts["body"] = std::move(picture.body);
    return emit::render_embedded("report/trade.svg", record).text;
}

}  // namespace lobe::report
