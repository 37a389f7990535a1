// The radiance of a model as one function of columns, and the box that a packing is measured over.
//
// The normal is the z axis: turning everything together changes nothing. Both directions are at
// least `least_cosine` above the horizon. Alpha follows roughness where a model reads both. A
// parameter that is not stored is at its default, as the engine knows no other value, unless the
// packing gives it a range with `over`.
#pragma once

#include "evaluate/tape.h"
#include "ir/module.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace lobe::analyze {

/// Half a hundredth of a degree. Nothing nearer to the horizon covers a pixel.
inline constexpr float least_cosine = 0x1p-13F;

/// One scalar input of the radiance.
struct Coordinate {
    std::string name;  ///< `l.x`, `roughness`, `f0.r`
    float low = 0;     ///< equal ends: it stays there
    float high = 0;
    bool whole = false;                  ///< holds integers only
    std::optional<std::size_t> field{};  ///< index into Packing::fields: it is stored
};

struct RadianceBox {
    evaluate::Tape tape;  ///< the sum of the model's outputs, one result per channel
    std::vector<Coordinate> coordinates;     ///< one per input of the tape
    std::optional<std::size_t> light, view;  ///< coordinate of l.x and v.x, where l and v occur
    std::vector<std::size_t> values;         ///< those that vary, matter and are no directions
    std::optional<std::size_t> roughness;    ///< where highlights are sharp
    std::optional<std::size_t> alpha;        ///< the same, of a term that takes alpha itself

    std::size_t width() const { return coordinates.size(); }
};

/// Of colors: all channels, or the first for a search that can do without the others.
enum class Channels : std::uint8_t {
    all,
    first
};

/// What stands for the geometry: vectors, or each field that is read, by itself.
enum class GeometryAs : std::uint8_t {
    vectors,
    fields
};

/// The sum of some functions, as one of the geometry and everything else that they read.
ir::Function radiance_of(const ir::Module& module, const std::vector<ir::FunctionId>& outputs,
                         Channels channels = Channels::all,
                         GeometryAs geometry = GeometryAs::vectors);

/// Every input over its declared range, parameters too.
RadianceBox whole_box(const ir::Module& module, const ir::Function& radiance);

/// `packing` names a model of the module, or of one that it imports.
RadianceBox radiance_box(const ir::Module& module, const ir::Packing& packing,
                         Channels channels = Channels::all);

}  // namespace lobe::analyze
