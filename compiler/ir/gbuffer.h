// What an engine's GBuffer is, as data: its targets and channels, how each is stored, who else
// reads it, and under which of the engine's settings it is there at all.
//
// Every `when` of a `gbuffer` block is decided for every configuration (one value per setting) when
// the block is checked. What is left is sets of configurations, so that a question like "is this
// channel there wherever the packing has to work" is an intersection, and its answer a
// configuration to show.
#pragma once

#include "ir/declarations.h"

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace lobe::ir {

/// `setting static_lighting "r.AllowStaticLighting" : off, on = on`
struct Setting {
    std::string name;
    std::string label;  ///< what the engine calls it
    std::vector<std::string> values;
    std::size_t default_value = 0;
    std::string doc;
    Span span;
};

/// A set of configurations of one gbuffer, by their number; see `Gbuffer::configuration`.
using Configurations = std::vector<bool>;

enum class Storage : std::uint8_t {
    unorm,
    snorm,
    floating,
    srgb
};

struct Format {
    Storage storage{};
    int bits = 0;
    friend bool operator==(const Format&, const Format&) = default;
};

/// `unorm 8`
std::string describe(Format format);

struct Channel {
    std::size_t target = 0;  ///< index into Gbuffer::targets
    std::string name;        ///< `r`
    std::string label;       ///< `CustomData.x`
    std::string field;       ///< `GBuffer.CustomData.x`; empty: no shader of a model can reach it
    std::vector<Format> formats;  ///< per configuration
    Configurations exists;
    double absent_value = 0;  ///< what is read where it does not exist
    /// The engine's own content. A packing may take a lent one by saying `without name`.
    struct Holder {
        std::string name;
        std::string text;
        bool lent = false;
        Configurations when;
        Span span;
    };
    std::vector<Holder> holders;
    /// `also`, `changes`
    struct Remark {
        std::string text;
        Configurations when;
        Span span;
    };
    std::vector<Remark> consumers;
    std::vector<Remark> changes;
    std::string doc;
    Span span;

    /// Nothing of the engine's lives in it, in any configuration.
    bool is_free() const { return holders.empty() && consumers.empty() && changes.empty(); }
};

struct RenderTarget {
    std::string name;   ///< `d`
    std::string label;  ///< `GBufferD`
    std::string doc;
    Span span;
};

/// `pin opacity "Opacity" in [0, 1] = 1`
struct Pin {
    std::string name;
    std::string label;
    std::optional<Range> range;  ///< none: the value passes as it is
    double default_value = 0;    ///< where nothing is connected
    std::string doc;
    Span span;
};

struct Gbuffer {
    std::string name;
    std::string module;
    std::string doc;
    Span span;
    std::vector<Setting> settings;
    std::vector<RenderTarget> targets;
    std::vector<Channel> channels;  ///< by target, in the order written
    std::vector<Pin> pins;

    /// The number of configurations: the product of the settings' values.
    std::size_t configurations() const;
    /// The index of the value of every setting in a configuration. The first setting counts
    /// slowest.
    std::vector<std::size_t> values(std::size_t configuration) const;
    std::size_t configuration(const std::vector<std::size_t>& values) const;
    std::size_t default_configuration() const;
    /// The configurations where a setting has one of these values.
    Configurations where(std::size_t setting, const std::vector<std::size_t>& values) const;
    /// `r.AllowStaticLighting = on, engine version = v4_27`: the settings that differ between the
    /// configurations of `of` and its complement come first, others are left out.
    std::string describe(std::size_t configuration, const Configurations& of) const;
    /// `d.r`
    std::string name_of(const Channel& channel) const;
    std::optional<std::size_t> find_channel(std::string_view target, std::string_view name) const;
    std::optional<std::size_t> find_pin(std::string_view name) const;
};

/// The member of a set that is nearest to the engine's own configuration: fewest settings differ;
/// nothing if the set is empty.
std::optional<std::size_t> nearest_to_default(const Gbuffer& gbuffer, const Configurations& set);

/// A channel that a packing may use, and the bits that it has at least, where the packing has to
/// work.
struct Room {
    std::size_t channel = 0;  ///< index into Gbuffer::channels
    int bits = 0;
};

/// The channels that a model can reach, that are there as unorm in every one of these
/// configurations and that nobody else uses in any of them, but for lent contents that the model
/// goes `without`. In the order of the gbuffer.
std::vector<Room> free_channels(const Gbuffer& gbuffer, const Configurations& supported,
                                const std::vector<std::string>& without);

Configurations both(const Configurations& a, const Configurations& b);
Configurations except(const Configurations& a, const Configurations& b);
bool any(const Configurations& set);

}  // namespace lobe::ir
