// JSON text to a tree of values that is safe to walk: no deeper than a limit, no member twice,
// every number finite. A complaint names the pointer of the value that was being read.
//
// A scene may have millions of values, so they lie in blocks, with no allocation of their own.
#pragma once

#include "scene/complaints.h"

#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace lobe::scene {

/// glTF needs nine levels; `extras` may need more.
constexpr std::size_t deepest_json = 64;

/// A value of a document, which owns it and whatever it refers to.
class Json {
public:
    enum class Kind : std::uint8_t {
        null,
        boolean,
        number,
        string,
        array,
        object
    };

    Json() = default;
    explicit Json(bool flag) : kind_{Kind::boolean} { content_.flag = flag; }
    explicit Json(double number) : kind_{Kind::number} { content_.number = number; }
    explicit Json(std::string_view text)
        : size_{static_cast<std::uint32_t>(text.size())}, kind_{Kind::string}
    {
        content_.text = text.data();
    }
    Json(Kind kind, std::span<const Json> children)
        : size_{static_cast<std::uint32_t>(children.size())}, kind_{kind}
    {
        content_.children = children.data();
    }

    Kind kind() const { return kind_; }
    bool is(Kind kind) const { return kind_ == kind; }

    // ---- what it holds; each for its own kind alone
    bool flag() const { return content_.flag; }
    double number() const { return content_.number; }
    std::string_view text() const { return {content_.text, size_}; }
    /// Elements in order, or members in alphabetical order.
    std::span<const Json> children() const { return {content_.children, size_}; }

    // ---- where it stands
    /// As a member of an object; else empty.
    std::string_view name() const { return {name_, name_size_}; }
    Pointer pointer() const;

    /// A member of an object; null where there is none, and for other kinds.
    const Json* find(std::string_view name) const;

private:
    friend class JsonBuilder;

    union Content {
        bool flag;
        double number;
        const char* text;
        const Json* children;
    };
    const Json* parent_ = nullptr;  ///< of the root: null
    const char* name_ = nullptr;
    Content content_{};
    std::uint32_t name_size_ = 0;
    std::uint32_t size_ = 0;
    Kind kind_ = Kind::null;
};

/// What a text says. Values stay where they are when it is moved.
class JsonDocument {
public:
    const Json& root() const { return *root_; }

private:
    friend class JsonBuilder;

    const Json* root_ = nullptr;
    std::vector<std::unique_ptr<Json[]>> values_;
    std::vector<std::unique_ptr<char[]>> characters_;
    std::deque<std::string> long_texts_;
};

/// The tree, or nothing after a complaint. Bytes after the value are an error, a byte order mark
/// too, as glTF has it.
std::optional<JsonDocument> parse_json(std::string_view text, Complaints& complaints);

/// `name` as a part of a JSON pointer, with its slash.
Pointer operator/(const Pointer& parent, std::string_view name);
Pointer operator/(const Pointer& parent, std::size_t index);

}  // namespace lobe::scene
