// How a model's parameters are stored in an engine's GBuffer, and how its material editor feeds
// them.
//
// A field stores one component of one parameter as a code, a whole number, in some bits of one or
// more channels. What the codes mean is given by functions of the module, so that every evaluator,
// every target and every proof reads the same description:
//
//   encode_<field>   value -> code          pack_<channel>      parameters -> what is stored there
//   decode_<field>   code -> value          unpack_<parameter>  what is stored -> its value
//
// (encode and decode are called by pack and unpack.) Codes travel as floats that are whole numbers;
// stored values are code / (2^bits - 1), as an UNORM channel reads. Rounding is explicit: to the
// nearest code, halves up, before storing; a stored value is rounded to the nearest code when read.
#pragma once

#include "ir/declarations.h"
#include "ir/gbuffer.h"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace lobe::ir {

struct Module;

/// Bits low .. low + bits - 1 of a channel's code; 0 is the least significant.
struct Slot {
    std::size_t channel = 0;  ///< index into Gbuffer::channels
    int low = 0;
    int bits = 0;
    friend bool operator==(const Slot&, const Slot&) = default;
};

/// How a value becomes a fraction u of the codes, u = code / last code:
///
///   linear(pivot)     u = pivot (x - low) / (high - low); pivot 1 uses every code
///   square_root       u = sqrt((x - low) / (high - low))
///   power(n, pivot)   u = pivot ((x - low) / unit)^(1/n): the default is stored at the pivot,
///                     or low + 1 where the default is the low end
///   log2(pivot)       u = pivot log2(1 + x - low): low + 1 is stored at the pivot; without a
///                     pivot the high end is stored at 1
///   halving(pivot)    u = pivot log2((top - x) / (top - low)) / log2((top - d) / (top - low)),
///                     where top is the parameter's own high end, which the field stays below, and
///                     d its default, which is stored at the pivot: equal steps halve what is
///                     missing to the top
///   declared          a `code` of the source
///
/// A pivot is a whole code over the last code. Codes that decode past the high end decode to it.
/// snorm fields have linear codes over [-high, high] and an exact 0: codes 0 .. 2^bits - 2.
struct Code {
    enum class Kind : std::uint8_t {
        linear,
        square_root,
        power,
        log2,
        halving,
        declared
    };
    Kind kind = Kind::linear;
    int exponent = 1;             ///< of power: 1 .. 32
    int pivot = 0;                ///< as a code, 1 .. last; 0: none
    double unit = 1;              ///< of power: how far above the low end the pivot's value is
    double top = 0;               ///< of halving
    double at_pivot = 0;          ///< of halving: the value that is stored there
    FunctionId encode;            ///< declared: value -> u, over the reals
    FunctionId decode;            ///< declared: u -> value
    std::string name = "linear";  ///< of a declared code
    friend bool operator==(const Code&, const Code&) = default;
};

/// As the source would say it for a field of so many bits: `power(8, 127/255)`.
std::string describe(const Code& code, int bits);

/// How far above the low end a power has its pivot.
double power_unit(const Parameter& parameter, int component, const Range& range);

/// The halving code of a parameter's component over a range; nothing unless the range ends below
/// the parameter's, which is finite, and the default lies inside.
std::optional<Code> halving(const Parameter& parameter, int component, const Range& range,
                            int pivot);

/// A value that a code must decode to, without any rounding.
struct Anchor {
    int code = 0;
    double value = 0;
    friend bool operator==(const Anchor&, const Anchor&) = default;
};

struct Field {
    std::uint32_t parameter = 0;  ///< index into Module::parameters
    int component = 0;            ///< of a color; 0 for a scalar
    std::vector<Slot> slots;      ///< most significant first
    int bits = 0;                 ///< of all slots together, 1 .. 16
    bool is_signed = false;       ///< snorm
    Range range{};                ///< what is carried; the parameter's unless the field says `in`
    Code code;
    std::vector<Anchor> anchors;  ///< values that must survive besides those that `kept_values`
                                  ///< knows; of a declared code all of them, as no formula says
                                  ///< which code they lie on. See check::place_anchors
    Span span;
    FunctionId encode;
    FunctionId decode;

    int last_code() const { return (1 << bits) - (is_signed ? 2 : 1); }
};

/// `require exact name == value`, for every component
struct ExactRequirement {
    std::uint32_t parameter = 0;
    double value = 0;
    Span span;
};

/// `over roughness in [0.1, 1]`: a surface field or a parameter, by name
struct MeasuredRange {
    std::string name;
    Range range{};
    Span span;
};

struct Packing {
    Model model;  ///< of this module or an imported one
    std::string gbuffer;
    std::string module;
    std::string doc;
    Span span;
    std::vector<Field> fields;  ///< in the order written
    std::vector<ExactRequirement> exact;
    std::optional<double> radiance_limit;  ///< 0.02 for 2%
    Span radiance_span;
    std::vector<MeasuredRange> measured;
    std::vector<std::string> without;  ///< names of Channel::Holder
    Configurations supported;

    struct PackedChannel {
        std::size_t channel = 0;
        FunctionId pack;  ///< inputs: the parameters (Origin::parameter) that live there
    };
    std::vector<PackedChannel> channels;  ///< in the gbuffer's order
    struct UnpackedParameter {
        std::uint32_t parameter = 0;
        FunctionId unpack;  ///< inputs: arguments named `d_r`, in the order of Packing::channels
        std::vector<std::size_t> channels;  ///< one per input: index into Packing::channels
    };
    std::vector<UnpackedParameter> parameters;  ///< in the order of Module::parameters
};

/// What a field is called in functions and messages: `retroreflection`, `tint_r`.
std::string field_name(const Module& module, const Field& field);

/// Where a value of the field's range lies among its codes: a real number, whole where the value is
/// that of a code, past the last code where no code reaches it. Not for declared codes.
double position(const Field& field, double value);

/// The code whose value this is: `position`, where it is whole but for the rounding of doubles.
std::optional<int> code_of(const Field& field, double value);

/// The values of a field's component that have to survive: the default, what is required to be
/// exact, for power and log2 low + 1, for snorm 0, its anchors. In this order, each once.
std::vector<double> kept_values(const Module& module, const Packing& packing, const Field& field);

/// The fewest bits that a channel has where the packing has to work: where it has more, a unorm
/// keeps the codes of these.
int channel_bits(const Packing& packing, const Channel& channel);

/// Adds encode, decode, pack and unpack of every field to the module's functions, in that order,
/// and their ids to the packing. The fields are sound: their bits lie in their channels without
/// overlap, pivots are codes, declared codes are functions of the module. Also what the search for
/// a packing builds its candidates with.
///
/// What is exact: every one of the `kept_values` that lies on a code decodes to the float nearest
/// to it without any rounding, on every device that follows Vulkan's precision table. Linear codes
/// are decoded from one of them on, `anchor + (code - anchor_code) * step`, powers from their pivot
/// on; where the arithmetic of a code does not make a kept value exact, its code is looked at by
/// itself. Nothing that the bits can hold decodes to a value outside of the field's range.
void build_functions(Module& module, Packing& packing, const Gbuffer& gbuffer);

/// `engine ue4 for callisto { … }`
struct Engine {
    std::string gbuffer;
    std::string model;
    std::string module;
    Span span;
    std::string shading_model;
    Span shading_model_span;
    struct PinUse {
        std::size_t pin = 0;  ///< index into Gbuffer::pins
        std::uint32_t parameter = 0;
        std::string label;
        Span span;
    };
    std::vector<PinUse> pins;
    struct Node {
        std::string name;
        std::vector<std::uint32_t> parameters;
        Span span;
    };
    std::optional<Node> node;
    std::optional<std::vector<double>> color;  ///< three, in [0, 1]
};

}  // namespace lobe::ir
