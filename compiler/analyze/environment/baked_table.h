// A function of one or two numbers as a table that a texture unit reads, and what that loses.
//
// In: a term of one or two scalars by its own definition, or the split sum of a visibility by exact
// quadrature. Out: texels as they are stored, and three errors apart: of storing, of interpolating,
// and of both. docs/environment.md argues the placement of texels.
#pragma once

#include "analyze/environment/texel_format.h"
#include "analyze/environment/visibility.h"
#include "analyze/minimax/fit.h"
#include "ir/module.h"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace lobe::analyze {

/// Where texels lie along an axis. `ends`: the first and the last on its ends. `centers`: in the
/// middle of equal parts, as if the axis itself were the texture coordinate.
enum class TexelPlaces : std::uint8_t {
    ends,
    centers
};

struct TableAxis {
    std::string name;
    double low = 0;
    double high = 1;
    double least = 0;  ///< of the argument itself: what is beyond is held there
    double greatest = 1;
    std::size_t size = 1;
    TexelPlaces places = TexelPlaces::ends;

    /// The argument at a texel, or between two: 0 is the first one's middle.
    double at(double texel) const;
    /// Where along the texels an argument is read: held in [0, size - 1].
    double texel_of(double argument) const;
    /// texture coordinate = `scale` argument + `offset`
    double scale() const;
    double offset() const;
};

/// Columns of results, one per component, at any number of places; y is 0 where there is one axis.
using PlaceFunction = std::function<std::vector<std::vector<double>>(std::span<const Place>)>;

/// What a table is made of.
struct BakeSubject {
    std::string name;
    std::string how;  ///< how values come about, in words
    std::vector<std::string> components;
    std::vector<TableAxis> axes;  ///< one, or two: across and down
    PlaceFunction texels;         ///< what goes into the table
    PlaceFunction exact;          ///< what errors are measured against
};

/// A term by its definition, in MPFR at 113 bits. Parameters are at their defaults. Nothing, and
/// `why` in words, unless it has one or two inputs, each a number with a finite range. `module` is
/// a checked one and outlives the result.
std::optional<BakeSubject> term_to_bake(const ir::Module& module, ir::FunctionId term,
                                        unsigned jobs, std::string& why);

/// Scale and bias of a visibility, over cos_o across and roughness down: the integrals, or with
/// `samples` above 0 the sum that stands for them, measured against the integrals.
BakeSubject split_sum_to_bake(std::string name, Visibility visibility, std::uint32_t samples,
                              unsigned jobs);

/// Of one component, absolute: the greatest, and the root of the mean square, over a lattice of
/// places that has points between all texels (or, of a large table, between evenly chosen ones).
struct BakeError {
    double worst = 0;
    double root_mean_square = 0;
    Place at{};  ///< of the worst
};

struct BakedComponent {
    std::string name;
    BakeError storage;        ///< of texels as stored against texels
    BakeError interpolation;  ///< linear between unrounded texels against exact
    BakeError together;       ///< linear between stored ones, with weights of 8 bits, against exact
};

struct BakedTable {
    BakeSubject subject;
    TexelFormat format;
    std::vector<std::uint32_t> codes;  ///< row by row, texel by texel, channel by channel
    std::vector<BakedComponent> components;
    std::size_t points = 0;  ///< that errors between texels were measured at

    std::size_t width() const { return subject.axes.front().size; }
    std::size_t height() const { return subject.axes.size() == 2 ? subject.axes[1].size : 1; }
    std::size_t bytes() const;
    /// The value that a channel of a texel reads as.
    double stored(std::size_t texel, std::size_t channel) const;
};

/// Channels without a component hold 0; a fourth one, 1. A unorm clamps what is up to 0.01 beyond.
/// Nothing, and `why` in words, where the format has too few channels or cannot hold a value.
/// `points` is about how many places errors are measured at.
std::optional<BakedTable> bake(const BakeSubject& subject, const TexelFormat& format,
                               std::size_t points, std::string& why);

}  // namespace lobe::analyze
