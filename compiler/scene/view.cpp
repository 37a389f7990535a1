// Checked access to the values of a file.
#include "scene/view.h"

#include "base/diagnostic.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace lobe::scene {
namespace {

using nlohmann::json;

std::string kind_of(const json& value)
{
    switch (value.type()) {
    case json::value_t::object: return "an object";
    case json::value_t::array: return "an array";
    case json::value_t::string: return "a string";
    case json::value_t::boolean: return "true or false";
    case json::value_t::number_integer:
    case json::value_t::number_unsigned:
    case json::value_t::number_float: return "a number";
    case json::value_t::null:
    case json::value_t::binary:
    case json::value_t::discarded: break;
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
std::optional<std::size_t> whole_number(const json& value)
{
    if (!value.is_number()) return std::nullopt;
    const double number = value.get<double>();
    constexpr double most = 9007199254740992;
    if (number < 0 || number > most || number != std::floor(number)) return std::nullopt;
    return static_cast<std::size_t>(number);
}

/// Names are the file's and may be long.
std::string quoted(const std::string& text)
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
    complaints_->error(pointer_, std::move(message), std::move(help));
}

View View::operator[](std::size_t index) const
{
    return {(*value_)[index], pointer_ / index, *complaints_};
}

std::vector<std::string> View::names() const
{
    std::vector<std::string> names;
    if (!is_object()) return names;
    for (const auto& [name, value] : value_->get_ref<const json::object_t&>())
        names.push_back(name);
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
    const double number = value_->get<double>();
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

std::vector<double> View::numbers(std::vector<double> otherwise, const Bounds& bounds) const
{
    if (!is_array() || size() != otherwise.size()) {
        expected(*this, fmt::format("an array of {} numbers", otherwise.size()));
        return otherwise;
    }
    for (std::size_t component = 0; component < otherwise.size(); ++component)
        otherwise[component] = (*this)[component].number(otherwise[component], bounds);
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

std::optional<std::string> View::text() const
{
    if (const auto* text = value_->get_ptr<const json::string_t*>()) return *text;
    expected(*this, "a string");
    return std::nullopt;
}

std::optional<View> View::member(std::string_view name) const
{
    const auto* members = value_->get_ptr<const json::object_t*>();
    if (members == nullptr) return std::nullopt;
    const auto found = members->find(name);
    if (found == members->end()) return std::nullopt;
    return View{found->second, pointer_ / name, *complaints_};
}

std::optional<View> View::object(std::string_view name) const
{
    auto found = member(name);
    if (found && !found->expect_object()) return std::nullopt;
    return found;
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

std::vector<double> View::numbers(std::string_view name, std::vector<double> otherwise,
                                  const Bounds& bounds) const
{
    const auto found = member(name);
    return found ? found->numbers(std::move(otherwise), bounds) : otherwise;
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
                                 found->value_->get<double>(), low, high));
    else
        expected(*found, "a whole number");
    return otherwise;
}

bool View::flag(std::string_view name, bool otherwise) const
{
    const auto found = member(name);
    if (!found) return otherwise;
    if (const auto* flag = found->value_->get_ptr<const json::boolean_t*>()) return *flag;
    expected(*found, "true or false");
    return otherwise;
}

std::string View::text(std::string_view name, std::string otherwise) const
{
    const auto found = member(name);
    if (!found) return otherwise;
    auto text = found->text();
    return text ? std::move(*text) : otherwise;
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
    const auto* members = value_->get_ptr<const json::object_t*>();
    if (members == nullptr) return;
    for (const auto& [name, value] : *members) {
        if (std::ranges::find(known, std::string_view{name}) != known.end()) continue;
        const auto near = nearest(name, {known.begin(), known.end()});
        complaints_->error(pointer_ / name, fmt::format("{} is not known here", quoted(name)),
                           near ? fmt::format("did you mean `{}`?", *near)
                                : fmt::format("known are {}", fmt::join(known, ", ")));
    }
}

}  // namespace lobe::scene
