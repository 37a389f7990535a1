// Accessors: arrays of vectors in buffers, of any component type, with gaps, sparse or all zero.
#pragma once

#include "scene/buffers.h"

#include <cstdint>
#include <optional>
#include <vector>

namespace lobe::scene {

enum class ComponentType : std::uint16_t {
    int8 = 5120,
    uint8 = 5121,
    int16 = 5122,
    uint16 = 5123,
    uint32 = 5125,
    float32 = 5126
};

/// Some of an accessor's values replace those of its view.
struct Sparse {
    std::size_t count = 0;
    ComponentType index_type = ComponentType::uint32;
    std::string_view indices;  ///< from the first one on
    std::string_view values;   ///< without gaps
};

struct Accessor {
    Pointer pointer;
    ComponentType type = ComponentType::float32;
    bool is_normalized = false;
    std::size_t count = 0;
    std::size_t rows = 1;     ///< components of a vector, or of a matrix' column
    std::size_t columns = 1;  ///< above 1: a matrix
    bool has_view = false;
    Window window{};  ///< from the first element on; none: zeros
    std::optional<Sparse> sparse;
};

/// Every accessor of the file, checked: all its bytes are there. What `read` gives is not.
class Accessors {
public:
    Accessors(const View& root, const Buffers& buffers);
    std::size_t size() const { return all_.size(); }
    /// Nothing where the accessor is broken: something was said then.
    const std::optional<Accessor>& operator[](std::size_t index) const { return all_[index]; }

private:
    std::vector<std::optional<Accessor>> all_;
};

/// The elements of a vector accessor, components one after another, normalized integers divided.
/// Nothing, after a complaint, where one is not finite.
std::optional<std::vector<float>> read_floats(const Accessor& accessor, Complaints& complaints);
/// The elements of a scalar accessor of unsigned integers.
std::vector<std::uint32_t> read_integers(const Accessor& accessor);

}  // namespace lobe::scene
