// `extras.lobe` of a material: a model's own parameters, and layers.
//
//   "parameters": {name: 0.5 | [1, 0.5, 0.5] | {"min": …, "max": …} | {"texture": {…}, …}}
//   "layers": [{"material": 3, "weight": 0.5 | {"min": …, "max": …} | {"texture": {…}, …}}]
//
// What a name means, and which values it takes, is known where the model is.
#include "scene/materials.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>

namespace lobe::scene {
namespace {

/// A number, or an array of up to four.
Components components(const View& view)
{
    if (!view.is_array()) return {view.number(0)};
    if (view.size() == 0 || view.size() > Components::most) {
        view.error(
            fmt::format("{} numbers; a parameter has 1 to {}", view.size(), Components::most));
        return {0};
    }
    Components numbers;
    for (std::size_t index = 0; index < view.size(); ++index)
        numbers.push_back(view[index].number(0));
    return numbers;
}

/// As many numbers as `count`; one number stands for all.
Components components(const View& holder, std::string_view name, std::size_t count,
                      double otherwise)
{
    const auto view = holder.member(name);
    if (!view) return Components(count, otherwise);
    Components numbers = components(*view);
    if (numbers.size() == 1) numbers.resize(count, numbers[0]);
    if (numbers.size() == count) return numbers;
    view->error(fmt::format("{} numbers for {} components", numbers.size(), count));
    return Components(count, otherwise);
}

/// Letters of `rgba`, at least one and at most `most`.
std::vector<int> channels(const View& holder, std::string_view name, std::size_t most)
{
    const auto view = holder.member(name);
    const auto letters = view ? view->text() : std::nullopt;
    if (!letters) return {0};
    std::vector<int> channels;
    for (const char letter : *letters) {
        const std::size_t channel = std::string_view{"rgba"}.find(letter);
        if (channel == std::string_view::npos || channels.size() == most) {
            channels.clear();
            break;
        }
        channels.push_back(static_cast<int>(channel));
    }
    if (!channels.empty()) return channels;
    view->error(most == 1 ? "a channel is one letter of `rgba`"
                          : "channels are one to four letters of `rgba`");
    return {0};
}

void read_texture(const View& view, Textures& textures, Value& value)
{
    view.allow_only({"offset", "scale", "texture"});
    value.channels = {0};
    if (const auto reference = view.object("texture")) {
        reference->allow_only(
            {"channel", "channels", "extensions", "extras", "index", "srgb", "texCoord"});
        if (reference->member("channel") && reference->member("channels"))
            reference->error("`channel` and `channels` are given");
        value.channels = reference->member("channels") ? channels(*reference, "channels", 4)
                                                       : channels(*reference, "channel", 1);
        value.is_srgb = reference->flag("srgb", false);
        value.texture = textures.read(*reference);
    }
    value.low = components(view, "scale", value.channels.size(), 1);
    value.high = value.low;
    value.offset = components(view, "offset", value.channels.size(), 0);
}

void read_range(const View& view, Value& value)
{
    view.allow_only({"max", "min"});
    if (view.require("min") && view.require("max")) {
        value.low = components(*view.member("min"));
        value.high = components(view, "max", value.low.size(), value.low[0]);
        for (std::size_t component = 0; component < value.low.size(); ++component)
            if (value.low[component] > value.high[component]) {
                view.error(fmt::format("`min` {} is above `max` {}", value.low[component],
                                       value.high[component]));
                value.high[component] = value.low[component];
            }
    } else {
        value.low = value.high = {0};
    }
}

Value read_value(const View& view, Textures& textures)
{
    Value value;
    value.pointer = view.pointer();
    value.is_given = true;
    if (view.member("texture"))
        read_texture(view, textures, value);
    else if (view.is_object())
        read_range(view, value);
    else
        value.low = value.high = components(view);
    value.offset.resize(value.low.size(), 0);
    return value;
}

/// A weight is one number in [0, 1], whatever the texture holds.
void check_weight(const View& view, const Value& weight)
{
    if (weight.low.size() != 1) {
        view.error("a weight is one number");
        return;
    }
    double low = weight.low[0] + weight.offset[0];
    double high = weight.high[0] + weight.offset[0];
    if (weight.texture) {
        low = weight.offset[0] + std::min(weight.low[0], 0.0);
        high = weight.offset[0] + std::max(weight.low[0], 0.0);
    }
    if (low >= 0 && high <= 1) return;
    view.error(low == high ? fmt::format("{} is outside what a weight may be: {}", low,
                                         describe(unit_bounds))
                           : fmt::format("{} to {} is outside what a weight may be: {}", low, high,
                                         describe(unit_bounds)));
}

std::optional<Layer> read_layer(const View& view, Textures& textures, std::size_t material_count)
{
    if (!view.expect_object()) return std::nullopt;
    view.allow_only({"material", "weight"});
    if (!view.require("material") || !view.require("weight")) return std::nullopt;
    Layer layer;
    const auto material = view.index("material", material_count, "materials");
    const View weight = *view.member("weight");
    layer.weight = read_value(weight, textures);
    check_weight(weight, layer.weight);
    if (!material) return std::nullopt;
    layer.material = *material;
    return layer;
}

}  // namespace

void read_parameters(const View& extras, Textures& textures, std::size_t material_count,
                     Material& material)
{
    extras.allow_only({"layers", "parameters"});
    if (const auto parameters = extras.object("parameters"))
        for (const std::string_view name : parameters->names())
            material.parameters.emplace_hint(material.parameters.end(), name,
                                             read_value(*parameters->member(name), textures));
    if (const auto layers = extras.array("layers"))
        for (std::size_t index = 0; index < layers->size(); ++index)
            if (auto layer = read_layer((*layers)[index], textures, material_count))
                material.layers.push_back(std::move(*layer));
}

}  // namespace lobe::scene
