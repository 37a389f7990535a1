// JSON text to a tree of values, by the events of nlohmann's parser: it holds no stack of its own
// that input could overflow, and it throws nothing as long as the events do not.
#include "scene/json.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cassert>
#include <string>
#include <utility>
#include <vector>

namespace lobe::scene {
namespace {

using nlohmann::json;

/// Line and column, both from 1, of the byte at `position`.
std::string place_in(std::string_view text, std::size_t position)
{
    const std::string_view before = text.substr(0, std::min(position, text.size()));
    const std::size_t line = 1 + static_cast<std::size_t>(std::ranges::count(before, '\n'));
    const std::size_t line_begin = before.find_last_of('\n') + 1;  // npos + 1 is 0
    return fmt::format("line {}, column {}", line, before.size() - line_begin + 1);
}

/// What nlohmann says of a text, without its own prefix, position and the bytes it saw.
std::string reason(std::string_view message)
{
    if (const auto at = message.find(" - "); at != message.npos) message.remove_prefix(at + 3);
    if (const auto at = message.find("; last read"); at != message.npos)
        message = message.substr(0, at);
    return std::string{message};
}

/// A part of a pointer, with its slash.
void append(Pointer& pointer, std::string_view name)
{
    pointer.push_back('/');
    if (name.find_first_of("~/") == name.npos) {
        pointer.append(name);
        return;
    }
    for (const char character : name) {
        if (character == '~')
            pointer += "~0";
        else if (character == '/')
            pointer += "~1";
        else
            pointer.push_back(character);
    }
}

}  // namespace

/// Builds the tree from events. Finished values wait in `waiting_` until what they are part of
/// ends; then they move to where they stay, side by side.
class JsonBuilder {
public:
    JsonBuilder(std::string_view text, Complaints& complaints)
        : text_{text}, complaints_{complaints}
    {
    }

    JsonDocument take()
    {
        assert(waiting_.size() == 1);
        const std::span<const Json> root = settle(waiting_);
        document_.root_ = root.data();
        return std::move(document_);
    }

    // ---- what nlohmann's parser calls; `false` ends it

    bool null() { return put(Json{}); }
    bool boolean(bool value) { return put(Json{value}); }
    bool number_integer(json::number_integer_t value) { return number(value); }
    bool number_unsigned(json::number_unsigned_t value) { return number(value); }
    bool number_float(json::number_float_t value, const json::string_t&) { return number(value); }
    bool string(json::string_t& value) { return put(Json{kept(value)}); }
    bool binary(json::binary_t&) { return false; }  // no JSON text has it

    bool start_object(std::size_t) { return open(Json::Kind::object); }
    bool start_array(std::size_t) { return open(Json::Kind::array); }
    bool end_object() { return close(); }
    bool end_array() { return close(); }

    bool key(json::string_t& name)
    {
        key_ = kept(name);
        return true;
    }

    /// `position` counts from 1; at the end it is one past the text.
    bool parse_error(std::size_t position, const std::string&, const json::exception& error)
    {
        constexpr int number_overflow = 406;
        if (error.id == number_overflow)
            complaints_.error(here(), "this number is not finite in 64 bits",
                              place_in(text_, position - 1));
        else
            complaints_.error(here(),
                              fmt::format("this is no JSON at {}: {}",
                                          place_in(text_, position - 1), reason(error.what())));
        return false;
    }

private:
    /// An object or array that has not ended.
    struct Open {
        Json::Kind kind{};
        std::string_view name;  ///< the member of its parent that it is
        std::size_t first = 0;  ///< in `waiting_`: its own values begin there
    };

    template <typename Number>
    bool number(Number value)
    {
        return put(Json{static_cast<double>(value)});
    }

    bool put(Json value)
    {
        value.name_ = key_.data();
        value.name_size_ = static_cast<std::uint32_t>(key_.size());
        waiting_.push_back(value);
        key_ = {};
        return true;
    }

    bool open(Json::Kind kind)
    {
        if (open_.size() == deepest_json) {
            complaints_.error(here(), fmt::format("more than {} levels deep", deepest_json));
            return false;
        }
        open_.push_back({kind, key_, waiting_.size()});
        key_ = {};
        return true;
    }

    bool close()
    {
        const Open ended = open_.back();
        const std::span<Json> children = std::span{waiting_}.subspan(ended.first);
        if (ended.kind == Json::Kind::object) {
            std::ranges::sort(children, {}, &Json::name);
            const auto twice = std::ranges::adjacent_find(children, {}, &Json::name);
            if (twice != children.end()) {
                complaints_.error(here() / twice->name(),
                                  fmt::format("`{}` is given twice", twice->name()));
                return false;
            }
        }
        const Json value{ended.kind, settle(children)};
        waiting_.resize(ended.first);
        open_.pop_back();
        key_ = ended.name;
        return put(value);
    }

    /// The values at the place where they stay. What is in them learns where that is.
    std::span<const Json> settle(std::span<const Json> values)
    {
        constexpr std::size_t block = 4096;
        if (free_values_.size() < values.size()) {
            const std::size_t size = std::max(block, values.size());
            free_values_ = {document_.values_.emplace_back(new Json[size]).get(), size};
        }
        const std::span<Json> settled = free_values_.first(values.size());
        free_values_ = free_values_.subspan(values.size());
        std::ranges::copy(values, settled.begin());
        for (const Json& value : settled)
            if (value.is(Json::Kind::array) || value.is(Json::Kind::object))
                for (const Json& child : value.children())
                    const_cast<Json&>(child).parent_ = &value;
        return settled;
    }

    /// The text at a place where it stays; `text` may be moved from.
    std::string_view kept(json::string_t& text)
    {
        constexpr std::size_t block = std::size_t{1} << 16;
        constexpr std::size_t is_long = block / 16;
        if (text.size() > is_long) return document_.long_texts_.emplace_back(std::move(text));
        if (free_characters_.size() < text.size())
            free_characters_ = {document_.characters_.emplace_back(new char[block]).get(), block};
        std::ranges::copy(text, free_characters_.begin());
        const std::string_view where{free_characters_.data(), text.size()};
        free_characters_ = free_characters_.subspan(text.size());
        return where;
    }

    /// Of the value that comes now.
    Pointer here() const
    {
        Pointer pointer;
        for (std::size_t level = 0; level < open_.size(); ++level) {
            const bool is_last = level + 1 == open_.size();
            if (open_[level].kind == Json::Kind::object) {
                const std::string_view name = is_last ? key_ : open_[level + 1].name;
                if (!is_last || !name.empty()) pointer = pointer / name;
            } else {
                const std::size_t end = is_last ? waiting_.size() : open_[level + 1].first;
                pointer = pointer / (end - open_[level].first);
            }
        }
        return pointer;
    }

    std::string_view text_;
    Complaints& complaints_;
    JsonDocument document_;
    std::span<Json> free_values_;
    std::span<char> free_characters_;
    std::vector<Open> open_;
    std::vector<Json> waiting_;
    std::string_view key_;  ///< the member of the innermost object that comes now
};

Pointer Json::pointer() const
{
    std::array<const Json*, deepest_json> path{};
    std::size_t depth = 0;
    for (const Json* at = this; at->parent_ != nullptr; at = at->parent_) path[depth++] = at;
    Pointer pointer;
    pointer.reserve(64);  // as long as most are
    for (std::size_t i = depth; i-- > 0;) {
        const Json* const parent = path[i]->parent_;
        if (parent->is(Kind::object))
            append(pointer, path[i]->name());
        else
            append(pointer, fmt::format_int(path[i] - parent->children().data()).c_str());
    }
    return pointer;
}

const Json* Json::find(std::string_view name) const
{
    if (!is(Kind::object)) return nullptr;
    const auto members = children();
    const auto found = std::ranges::lower_bound(members, name, {}, &Json::name);
    return found != members.end() && found->name() == name ? &*found : nullptr;
}

Pointer operator/(const Pointer& parent, std::string_view name)
{
    Pointer pointer;
    pointer.reserve(parent.size() + 1 + name.size());
    pointer = parent;
    append(pointer, name);
    return pointer;
}

Pointer operator/(const Pointer& parent, std::size_t index)
{
    return parent + '/' + std::to_string(index);
}

std::optional<JsonDocument> parse_json(std::string_view text, Complaints& complaints)
{
    if (text.starts_with("\xEF\xBB\xBF")) {
        complaints.error("", "a byte order mark comes before the JSON");
        return std::nullopt;
    }
    JsonBuilder builder{text, complaints};
    if (!json::sax_parse(text, &builder)) return std::nullopt;
    return builder.take();
}

}  // namespace lobe::scene
