// A value of the file and where it stands, with accessors that check what they give: a value of
// another type, or outside its bounds, is an error at its pointer, and the caller goes on with a
// value that is safe.
#pragma once

#include "scene/json.h"

#include <array>
#include <initializer_list>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace lobe::scene {

/// What a number may be.
struct Bounds {
    double low = -std::numeric_limits<double>::infinity();
    double high = std::numeric_limits<double>::infinity();
    bool above_low = false;   ///< `low` itself is outside
    bool below_high = false;  ///< `high` itself is outside
};

constexpr Bounds unit_bounds{0, 1};
constexpr Bounds not_negative{0};
constexpr Bounds positive{0, std::numeric_limits<double>::infinity(), true};

using Names = std::initializer_list<std::string_view>;

class View {
public:
    View(const Json& value, Complaints& complaints) : View{value, value, complaints} {}

    Pointer pointer() const { return place_->pointer(); }
    const Json& value() const { return *value_; }
    Complaints& complaints() const { return *complaints_; }
    void error(std::string message, std::string help = {}) const;

    // ---- what this value is; no complaints
    bool is_object() const { return value_->is(Json::Kind::object); }
    bool is_array() const { return value_->is(Json::Kind::array); }
    bool is_number() const { return value_->is(Json::Kind::number); }
    /// Of an array; 0 for anything else.
    std::size_t size() const { return is_array() ? value_->children().size() : 0; }
    /// Of an array, by an index below size().
    View operator[](std::size_t index) const;
    /// Of an object, in alphabetical order; none for anything else.
    std::vector<std::string_view> names() const;

    // ---- this value, checked
    bool expect_object() const;
    double number(double otherwise, const Bounds& bounds = {}) const;
    /// As many as `into` has, which keeps its own where these are wrong.
    void fill(std::span<double> into, const Bounds& bounds = {}) const;
    Components numbers(Components otherwise, const Bounds& bounds = {}) const;
    /// An index into `what`, of which there are `size`.
    std::optional<std::size_t> index(std::size_t size, std::string_view what) const;
    /// It is the document's.
    std::optional<std::string_view> text() const;

    // ---- members of this object, checked; a member that is not there is no error
    std::optional<View> member(std::string_view name) const;
    std::optional<View> object(std::string_view name) const;
    /// An empty object where this one stands, if there is none.
    View object_or_empty(std::string_view name) const;
    /// An empty one is as good as none.
    std::optional<View> array(std::string_view name) const;
    double number(std::string_view name, double otherwise, const Bounds& bounds = {}) const;
    Components numbers(std::string_view name, const Components& otherwise,
                       const Bounds& bounds = {}) const;
    /// A unit quaternion, made exactly so; none where it is absent.
    std::array<double, 4> rotation(std::string_view name) const;
    /// A whole number from `low` to `high`.
    std::size_t whole(std::string_view name, std::size_t otherwise, std::size_t low,
                      std::size_t high) const;
    bool flag(std::string_view name, bool otherwise) const;
    std::string text(std::string_view name, std::string otherwise = {}) const;
    /// The position of the member in `choices`: the first where it is absent, none where it is
    /// another.
    std::optional<std::size_t> choice(std::string_view name, Names choices) const;
    std::optional<std::size_t> index(std::string_view name, std::size_t size,
                                     std::string_view what) const;
    /// Says that a member has to be there. True if it is.
    bool require(std::string_view name) const;
    /// An extension's object.
    std::optional<View> extension(std::string_view name) const;
    /// `extras.lobe`.
    std::optional<View> extras() const;
    /// Members other than these are errors, with the nearest of them as help.
    void allow_only(Names known) const;

private:
    View(const Json& value, const Json& place, Complaints& complaints)
        : value_{&value}, place_{&place}, complaints_{&complaints}
    {
    }

    const Json* value_;
    const Json* place_;  ///< the value whose pointer it has
    Complaints* complaints_;
};

/// `no more than 3`, `at least 0`, `between 0 and 1`.
std::string describe(const Bounds& bounds);

}  // namespace lobe::scene
