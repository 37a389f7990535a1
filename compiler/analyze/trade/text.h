// Trades and deviations as text, to be kept between runs: one line per thing, numbers with every
// digit. What was not written by this very program is never read.
#pragma once

#include "analyze/pareto.h"

#include <optional>
#include <string>
#include <string_view>

namespace lobe::analyze {

/// Adds a line.
void put(std::string& text, const Deviation& deviation);
void put(std::string& text, const std::optional<ProvedRounding>& proved);
void put(std::string& text, const Cost& cost);

/// Takes lines off a text. After something was not as expected it takes nothing more.
class Reader {
public:
    explicit Reader(std::string_view text) : rest_{text} {}

    void take(Deviation& out);
    void take(std::optional<ProvedRounding>& out);
    void take(Cost& out);
    /// The rest of the line.
    void take(std::string& out);
    template <class Number>
    void take_number(Number& out);

    bool is_sound() const { return sound_; }
    /// Everything was taken, and it was as expected.
    bool is_done() const { return sound_ && rest_.empty(); }

private:
    std::string_view line();

    std::string_view rest_;
    bool sound_ = true;
};

std::string to_text(const Trade& trade);
/// Without the standing of its candidates: `judge` finds that.
std::optional<Trade> read_trade(std::string_view text);

}  // namespace lobe::analyze
