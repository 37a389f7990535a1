// Checked access to the values of a file.
#include "scene/view.h"

#include "base/diagnostic.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace lobe::scene {
namespace {

std::string kind_of(const Json& value)
{
    switch (value.kind()) {
    case Json::Kind::object: return "an object";
    case Json::Kind::array: return "an array";
    case Json::Kind::string: return "a string";
    case Json::Kind::boolean: return "true or false";
    case Json::Kind::number: return "a number";
    case Json::Kind::null: break;
    }
    return "null";
}

bool contains(const Bounds& bounds, double value)
{
    const bool is_above = bounds.above_low ? value > bounds.low : value >= bounds.low;
    const bool is_below = bounds.below_high ? value < bounds.high : value <= bounds.high;
    return is_above && is_below;
}

void expected(const View& view, std::string_view what)
{
    view.error(fmt::format("{} is expected here, this is {}", what, kind_of(view.value())));
}

/// Up to 2^53, where every whole number is one of a JSON reader's too.
std::optional<std::size_t> whole_number(const Json& value)
{
    if (!value.is(Json::Kind::number)) return std::nullopt;
    const double number = value.number();
    constexpr double most = 9007199254740992;
    if (number < 0 || number > most || number != std::floor(number)) return std::nullopt;
    return static_cast<std::size_t>(number);
}

/// Names are the file's and may be long.
std::string quoted(std::string_view text)
{
    constexpr std::size_t longest = 60;
    if (text.size() <= longest) return fmt::format("`{}`", text);
    std::size_t end = longest;
    while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xC0U) == 0x80U) --end;
    return fmt::format("`{}…`", text.substr(0, end));
}

}  // namespace

std::string describe(const Bounds& bounds)
{
    const bool has_low = std::isfinite(bounds.low);
    const bool has_high = std::isfinite(bounds.high);
    const std::string low =
        fmt::format("{} {}", bounds.above_low ? "above" : "at least", bounds.low);
    const std::string high =
        fmt::format("{} {}", bounds.below_high ? "below" : "at most", bounds.high);
    if (has_low && has_high) return low + " and " + high;
    if (has_low) return low;
    if (has_high) return high;
    return "finite";
}

void View::error(std::string message, std::string help) const
{
    complaints_->error(pointer(), std::move(message), std::move(help));
}

View View::operator[](std::size_t index) const { return {value_->children()[index], *complaints_}; }

std::vector<std::string_view> View::names() const
{
    std::vector<std::string_view> names;
    if (!is_object()) return names;
    for (const Json& member : value_->children()) names.push_back(member.name());
    return names;
}

bool View::expect_object() const
{
    if (!is_object()) expected(*this, "an object");
    return is_object();
}

double View::number(double otherwise, const Bounds& bounds) const
{
    if (!is_number()) {
        expected(*this, "a number");
        return otherwise;
    }
    const double number = value_->number();
    if (!std::isfinite(number)) {
        error("this number is not finite in 64 bits");
        return otherwise;
    }
    if (!contains(bounds, number)) {
        error(fmt::format("{} is outside what it may be: {}", number, describe(bounds)));
        return otherwise;
    }
    return number;
}

void View::fill(std::span<double> into, const Bounds& bounds) const
{
    if (!is_array() || size() != into.size()) {
        expected(*this, fmt::format("an array of {} numbers", into.size()));
        return;
    }
    for (std::size_t at = 0; at < into.size(); ++at)
        into[at] = (*this)[at].number(into[at], bounds);
}

Components View::numbers(Components otherwise, const Bounds& bounds) const
{
    fill({otherwise.begin(), otherwise.end()}, bounds);
    return otherwise;
}

std::optional<std::size_t> View::index(std::size_t size, std::string_view what) const
{
    const auto index = whole_number(*value_);
    if (!index) {
        expected(*this, fmt::format("an index into `{}`", what));
        return std::nullopt;
    }
    if (*index < size) return index;
    if (size == 0)
        error(fmt::format("there are no `{}`, and this is index {}", what, *index));
    else
        error(fmt::format("{} is past the end of `{}`, which has {}", *index, what, size));
    return std::nullopt;
}

std::optional<std::string_view> View::text() const
{
    if (value_->is(Json::Kind::string)) return value_->text();
    expected(*this, "a string");
    return std::nullopt;
}

std::optional<View> View::member(std::string_view name) const
{
    const Json* const found = value_->find(name);
    if (found == nullptr) return std::nullopt;
    return View{*found, *complaints_};
}

std::optional<View> View::object(std::string_view name) const
{
    auto found = member(name);
    if (found && !found->expect_object()) return std::nullopt;
    return found;
}

View View::object_or_empty(std::string_view name) const
{
    static const Json nothing{Json::Kind::object, {}};
    return object(name).value_or(View{nothing, *place_, *complaints_});
}

std::optional<View> View::array(std::string_view name) const
{
    auto found = member(name);
    if (!found) return std::nullopt;
    if (!found->is_array()) {
        expected(*found, "an array");
        return std::nullopt;
    }
    if (found->size() == 0) return std::nullopt;
    return found;
}

double View::number(std::string_view name, double otherwise, const Bounds& bounds) const
{
    const auto found = member(name);
    return found ? found->number(otherwise, bounds) : otherwise;
}

Components View::numbers(std::string_view name, const Components& otherwise,
                         const Bounds& bounds) const
{
    const auto found = member(name);
    return found ? found->numbers(otherwise, bounds) : otherwise;
}

std::array<double, 4> View::rotation(std::string_view name) const
{
    const std::array<double, 4> none{0, 0, 0, 1};
    const auto found = member(name);
    if (!found) return none;
    const auto given = found->numbers({0, 0, 0, 1});
    const double length =
        std::hypot(std::hypot(given[0], given[1]), std::hypot(given[2], given[3]));
    // Components that were normalized bytes are off by up to half a step of 1/127 each, so the
    // length by up to sqrt(4) of these halves.
    if (std::abs(length - 1) <= 1.0 / 127)
        return {given[0] / length, given[1] / length, given[2] / length, given[3] / length};
    found->error(fmt::format("a rotation is a unit quaternion; this one has length {}", length));
    return none;
}

std::size_t View::whole(std::string_view name, std::size_t otherwise, std::size_t low,
                        std::size_t high) const
{
    const auto found = member(name);
    if (!found) return otherwise;
    const auto whole = whole_number(*found->value_);
    if (whole && *whole >= low && *whole <= high) return *whole;
    if (found->is_number())
        found->error(fmt::format("{} is no whole number of at least {} and at most {}",
                                 found->value_->number(), low, high));
    else
        expected(*found, "a whole number");
    return otherwise;
}

bool View::flag(std::string_view name, bool otherwise) const
{
    const auto found = member(name);
    if (!found) return otherwise;
    if (found->value_->is(Json::Kind::boolean)) return found->value_->flag();
    expected(*found, "true or false");
    return otherwise;
}

std::string View::text(std::string_view name, std::string otherwise) const
{
    const auto found = member(name);
    if (!found) return otherwise;
    const auto text = found->text();
    return text ? std::string{*text} : otherwise;
}

std::optional<std::size_t> View::choice(std::string_view name, Names choices) const
{
    const auto found = member(name);
    if (!found) return 0;
    const auto text = found->text();
    if (!text) return std::nullopt;
    const auto at = std::ranges::find(choices, std::string_view{*text});
    if (at != choices.end()) return static_cast<std::size_t>(at - choices.begin());
    found->error(fmt::format("{} is none of {}", quoted(*text), fmt::join(choices, ", ")));
    return std::nullopt;
}

std::optional<std::size_t> View::index(std::string_view name, std::size_t size,
                                       std::string_view what) const
{
    const auto found = member(name);
    return found ? found->index(size, what) : std::nullopt;
}

bool View::require(std::string_view name) const
{
    if (member(name)) return true;
    error(fmt::format("`{}` is missing", name));
    return false;
}

std::optional<View> View::extension(std::string_view name) const
{
    if (const auto all = object("extensions")) return all->object(name);
    return std::nullopt;
}

std::optional<View> View::extras() const
{
    const auto extras = member("extras");  // anything may stand there, and need not be an object
    return extras ? extras->object("lobe") : std::nullopt;
}

void View::allow_only(Names known) const
{
    if (!is_object()) return;
    for (const Json& member : value_->children()) {
        const std::string_view name = member.name();
        if (std::ranges::find(known, name) != known.end()) continue;
        const auto near = nearest(name, {known.begin(), known.end()});
        complaints_->error(member.pointer(), fmt::format("{} is not known here", quoted(name)),
                           near ? fmt::format("did you mean `{}`?", *near)
                                : fmt::format("known are {}", fmt::join(known, ", ")));
    }
}

}  // namespace lobe::scene
