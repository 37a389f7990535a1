#include "analyze/trade/text.h"

#include <fmt/format.h>

#include <charconv>

namespace lobe::analyze {
namespace {

/// Numbers that stand apart by spaces, and what is after them.
class Words {
public:
    explicit Words(std::string_view line) : rest_{line} {}

    template <class Number>
    bool take(Number& number)
    {
        const auto [end, error] =
            std::from_chars(rest_.data(), rest_.data() + rest_.size(), number);
        if (error != std::errc{}) return false;
        rest_.remove_prefix(static_cast<std::size_t>(end - rest_.data()));
        if (rest_.starts_with(' ')) rest_.remove_prefix(1);
        return true;
    }

    std::string_view rest() const { return rest_; }

private:
    std::string_view rest_;
};

}  // namespace

void put(std::string& text, const Deviation& d)
{
    text += fmt::format("{} {} {} {} {} {} {} {} {}\n", d.scaled, d.often, d.typical, d.absolute,
                        d.root_mean_square, d.codes, d.points, d.not_finite, d.at);
}

void put(std::string& text, const std::optional<ProvedRounding>& proved)
{
    if (proved)
        text += fmt::format("{} {} {} {}\n", proved->bound, proved->observed, proved->any_device,
                            proved->over);
    else
        text += "\n";
}

void put(std::string& text, const Cost& cost)
{
    text += fmt::format("{} {}", cost.spirv_instructions, cost.families.size());
    for (const auto& [family, at] : cost.families)
        text += fmt::format(" {} {} {} {} {} {} {} {}", static_cast<int>(family), at.valu,
                            at.transcendental, at.issue, at.inverse_throughput, at.latency,
                            at.vgprs, at.waves);
    text += "\n";
}

std::string_view Reader::line()
{
    const auto end = rest_.find('\n');
    sound_ = sound_ && end != std::string_view::npos;
    if (!sound_) return {};
    const std::string_view line = rest_.substr(0, end);
    rest_.remove_prefix(end + 1);
    return line;
}

void Reader::take(std::string& out) { out = line(); }

template <class Number>
void Reader::take_number(Number& out)
{
    Words words{line()};
    sound_ = sound_ && words.take(out) && words.rest().empty();
}

void Reader::take(Deviation& out)
{
    Words words{line()};
    sound_ = sound_ && words.take(out.scaled) && words.take(out.often) && words.take(out.typical) &&
             words.take(out.absolute) && words.take(out.root_mean_square) &&
             words.take(out.codes) && words.take(out.points) && words.take(out.not_finite);
    out.at = words.rest();
}

void Reader::take(std::optional<ProvedRounding>& out)
{
    Words words{line()};
    if (!sound_ || words.rest().empty()) return;
    ProvedRounding& proved = out.emplace();
    sound_ =
        words.take(proved.bound) && words.take(proved.observed) && words.take(proved.any_device);
    proved.over = words.rest();
}

void Reader::take(Cost& out)
{
    Words words{line()};
    std::size_t families = 0;
    sound_ = sound_ && words.take(out.spirv_instructions) && words.take(families) &&
             families <= all_families.size();
    if (!sound_) return;
    for (std::size_t i = 0; i < families && sound_; ++i) {
        std::size_t family = 0;
        sound_ = words.take(family) && family < all_families.size();
        if (!sound_) return;
        FamilyCost& at = out.families[all_families[family]];
        sound_ = words.take(at.valu) && words.take(at.transcendental) && words.take(at.issue) &&
                 words.take(at.inverse_throughput) && words.take(at.latency) &&
                 words.take(at.vgprs) && words.take(at.waves);
    }
}

std::string to_text(const Trade& trade)
{
    std::string text =
        fmt::format("{}\n{}\n{}\n{}\n{}\n", trade.name, trade.search, int{trade.whole_model},
                    int{trade.from_vectors}, trade.candidates.size());
    for (const Candidate& candidate : trade.candidates) {
        text += fmt::format("{}\n", candidate.choice.size());
        for (const auto& [term, form] : candidate.choice)
            text += fmt::format("{}\n{}\n", term, form);
        text += fmt::format("{}\n{}\n{}\n{}\n{}\n", static_cast<int>(candidate.spelling),
                            static_cast<int>(candidate.format), int{candidate.found},
                            int{candidate.selectable}, candidate.note);
        put(text, candidate.model);
        put(text, candidate.rounding);
        put(text, candidate.total);
        put(text, candidate.proved);
        put(text, candidate.cost);
        put(text, candidate.from_vectors);
    }
    return text;
}

std::optional<Trade> read_trade(std::string_view text)
{
    Reader reader{text};
    const auto flag = [&reader] {
        int value = 0;
        reader.take_number(value);
        return value;
    };
    Trade out;
    reader.take(out.name);
    reader.take(out.search);
    out.whole_model = flag() != 0;
    out.from_vectors = flag() != 0;
    std::size_t count = 0;
    reader.take_number(count);
    for (std::size_t i = 0; i < count && reader.is_sound(); ++i) {
        Candidate& candidate = out.candidates.emplace_back();
        std::size_t forms = 0;
        reader.take_number(forms);
        for (std::size_t k = 0; k < forms && reader.is_sound(); ++k) {
            std::string term;
            reader.take(term);
            reader.take(candidate.choice[term]);
        }
        candidate.spelling = static_cast<optimize::Spelling>(flag());
        candidate.format = static_cast<Format>(flag());
        candidate.found = flag() != 0;
        candidate.selectable = flag() != 0;
        reader.take(candidate.note);
        reader.take(candidate.model);
        reader.take(candidate.rounding);
        reader.take(candidate.total);
        reader.take(candidate.proved);
        reader.take(candidate.cost);
        reader.take(candidate.from_vectors);
    }
    if (!reader.is_done()) return std::nullopt;
    return out;
}

}  // namespace lobe::analyze
