// JSON text to a tree of values, by the events of nlohmann's parser: it holds no stack of its own
// that input could overflow, and it throws nothing as long as the events do not.
#include "scene/json.h"

#include <fmt/format.h>

#include <algorithm>
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

/// Builds the tree from events. `open_` are the objects and arrays around the current value.
class Builder : public json::json_sax_t {
public:
    Builder(std::string_view text, Complaints& complaints) : text_{text}, complaints_{complaints} {}

    json root;

    bool null() override { return put(nullptr); }
    bool boolean(bool value) override { return put(value); }
    bool number_integer(number_integer_t value) override { return put(value); }
    bool number_unsigned(number_unsigned_t value) override { return put(value); }
    bool number_float(number_float_t value, const string_t&) override { return put(value); }
    bool string(string_t& value) override { return put(std::move(value)); }
    bool binary(binary_t&) override { return false; }  // no JSON text has it

    bool start_object(std::size_t) override { return open(json::object()); }
    bool start_array(std::size_t) override { return open(json::array()); }
    bool end_object() override { return close(); }
    bool end_array() override { return close(); }

    bool key(string_t& name) override
    {
        json& object = *open_.back();
        const auto [slot, is_new] = object.get_ref<json::object_t&>().emplace(name, nullptr);
        key_ = name;
        slot_ = &slot->second;
        if (is_new) return true;
        complaints_.error(here(), fmt::format("`{}` is given twice", name));
        return false;
    }

    /// `position` counts from 1; at the end it is one past the text.
    bool parse_error(std::size_t position, const std::string&,
                     const json::exception& error) override
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
    template <typename Value>
    bool put(Value&& value)
    {
        next() = std::forward<Value>(value);
        key_.clear();
        return true;
    }

    /// The place of the value that comes now.
    json& next()
    {
        if (open_.empty()) return root;
        json& parent = *open_.back();
        if (parent.is_object()) return *slot_;
        return parent.get_ref<json::array_t&>().emplace_back();
    }

    bool open(json value)
    {
        if (open_.size() == deepest_json) {
            complaints_.error(here(), fmt::format("more than {} levels deep", deepest_json));
            return false;
        }
        json& place = next();
        keys_.push_back(key_);
        place = std::move(value);
        open_.push_back(&place);
        key_.clear();
        return true;
    }

    bool close()
    {
        open_.pop_back();
        keys_.pop_back();
        key_.clear();
        return true;
    }

    /// Of the value that comes now. Arrays grow only at their end, so that is where it is.
    Pointer here() const
    {
        Pointer pointer;
        for (std::size_t level = 0; level < open_.size(); ++level) {
            const json& parent = *open_[level];
            const bool is_last = level + 1 == open_.size();
            const std::string& name = is_last ? key_ : keys_[level + 1];
            if (parent.is_object()) {
                if (!is_last || !name.empty()) pointer = pointer / name;
            } else {
                pointer = pointer / (is_last ? parent.size() : parent.size() - 1);
            }
        }
        return pointer;
    }

    std::string_view text_;
    Complaints& complaints_;
    std::vector<json*> open_;
    std::vector<std::string> keys_;  ///< per open level, the member of its parent that it is
    std::string key_;                ///< the member of the innermost object that comes now
    json* slot_ = nullptr;           ///< its place
};

}  // namespace

Pointer operator/(const Pointer& parent, std::string_view name)
{
    Pointer pointer;
    pointer.reserve(parent.size() + 1 + name.size());
    pointer.append(parent).push_back('/');
    if (name.find_first_of("~/") == name.npos) return pointer.append(name);
    for (const char character : name) {
        if (character == '~')
            pointer += "~0";
        else if (character == '/')
            pointer += "~1";
        else
            pointer.push_back(character);
    }
    return pointer;
}

Pointer operator/(const Pointer& parent, std::size_t index)
{
    return parent + '/' + std::to_string(index);
}

std::optional<nlohmann::json> parse_json(std::string_view text, Complaints& complaints)
{
    if (text.starts_with("\xEF\xBB\xBF")) {
        complaints.error("", "a byte order mark comes before the JSON");
        return std::nullopt;
    }
    Builder builder{text, complaints};
    if (!json::sax_parse(text, &builder)) return std::nullopt;
    return std::move(builder.root);
}

}  // namespace lobe::scene
