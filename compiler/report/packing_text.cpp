// The whole report for a terminal.
#include "report/packing_layout.h"
#include "report/packing_plot.h"
#include "report/packing_svg.h"

#include <fmt/format.h>

#include <algorithm>

namespace lobe::report {
namespace {

/// What a suggestion has to say besides its packing.
std::string suggestion_text(const Packed& packed, const Look& look)
{
    const analyze::Suggestion& suggestion = *packed.suggestion;
    std::string out;
    if (suggestion.found) {
        out += suggestion.text + (suggestion.text.ends_with('\n') ? "\n" : "\n\n");
        out += comparison(packed) + "\n";
    } else {
        out += folded(suggestion.why_not, 0, look);
    }
    if (!suggestion.give_ups.empty()) {
        out += suggestion.found ? "to gain more, give up\n" : "to fit, give up\n";
        for (const std::string& give_up : suggestion.give_ups) out += folded(give_up, 2, look);
        out += "\n";
    }
    if (!suggestion.curves.empty()) {
        // What is left beside the names and the codes, six characters a column.
        constexpr int others = 44, each = 7;
        const int columns = look.width > 0 ? std::max((look.width - others) / each, 3) : 0;
        out += render(curve_table(suggestion, columns), look) + "\n";
    }
    if (!suggestion.trade.empty()) {
        out += render(trade_table(suggestion), look) + "\n";
        out += plot_text(trade_plot(packed), look) + "\n";
    }
    return out;
}

}  // namespace

std::string folded(const std::string& text, std::size_t indent, const Look& look)
{
    const auto width = static_cast<std::size_t>(look.width > 0 ? look.width : 80);
    std::string out, line;
    for (std::size_t at = 0; at < text.size();) {
        const std::size_t end = std::min(text.find(' ', at), text.size());
        const std::string word = text.substr(at, end - at);
        if (!line.empty() && indent + line.size() + 1 + word.size() > width) {
            out += std::string(indent, ' ') + line + "\n";
            line.clear();
        }
        line += (line.empty() ? "" : " ") + word;
        at = end + 1;
    }
    return line.empty() ? out : out + std::string(indent, ' ') + line + "\n";
}

std::string error_listing(const Packed& packed, const Look& look)
{
    const std::string table = render(error_table(packed), look);
    std::string out;
    std::size_t at = 0, row = 0;
    const auto next_line = [&] {
        const std::size_t end = table.find('\n', at) + 1;
        out += table.substr(at, end - at);
        at = end;
    };
    next_line();
    const auto& parameters = packed.errors.parameters;
    for (; at < table.size(); ++row) {
        next_line();
        const analyze::RadianceError& error =
            row < parameters.size() ? parameters[row].error : packed.errors.whole;
        if (error.worst == 0) continue;
        std::string words = folded(in_words(packed, error.witness), 4, look);
        if (!look.color) {
            out += words;
            continue;
        }
        words.pop_back();
        out += styled(words, Style::faint, true) + "\n";
    }
    return out;
}

std::string comparison(const Packed& packed)
{
    if (packed.suggestion == nullptr || !packed.suggestion->found) return {};
    const double worst = packed.errors.whole.worst;
    const double linear = packed.suggestion->linear.whole.worst;
    const std::size_t parameters = packed.suggestion->curves.size();
    int bits = 0;
    for (const ir::Field& field : packed.packing->fields) bits += field.bits;
    std::string out = fmt::format("{} parameters in {} bits: worst radiance error {}\n", parameters,
                                  bits, percent(worst));
    out += fmt::format("8 linear bits for each, {} bits: {}", 8 * parameters, percent(linear));
    if (worst > 0) out += fmt::format(", {:.3g} times as much", linear / worst);
    out += "\n";
    if (packed.limit && !packed.met)
        out += fmt::format("less than {} is asked for, and not reached\n", percent(*packed.limit));
    if (packed.written_error)
        out += fmt::format("the packing in the source, {} bits: {}\n", packed.written_bits,
                           percent(*packed.written_error));
    return out;
}

std::string to_text(const Packed& packed, const Look& look)
{
    std::string out = styled(title_of(packed), Style::strong, look.color) + "\n\n";
    if (packed.suggestion == nullptr || packed.suggestion->found) {
        out += layout_picture(packed, look) + "\n";
        out += render(field_table(packed), look) + "\n";
        out += error_listing(packed, look);
        out +=
            fmt::format("  {} points, then uphill from the worst\n", grouped(packed.errors.points));
    }
    if (packed.suggestion != nullptr) out += "\n" + suggestion_text(packed, look);
    return out;
}

}  // namespace lobe::report
