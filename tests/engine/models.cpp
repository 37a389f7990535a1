#include "engine/models.h"

#include "base/render.h"
#include "compile.h"

#include <catch2/catch.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <sstream>

namespace lobe::engine {
namespace {

struct Compiled {
    Sources sources;
    ir::Module module;
};

/// The text without its packings and engine blocks: these tests have their own.
std::string without_blocks(std::string text)
{
    for (const std::string word : {"\npacking ", "\nengine "})
        for (;;) {
            std::size_t at = text.find(word);
            if (at == std::string::npos) break;
            const std::size_t end = text.find("\n}\n", at);
            REQUIRE(end != std::string::npos);
            while (text.compare(text.rfind('\n', at - 1), 4, "\n///") == 0)
                at = text.rfind('\n', at - 1);
            text.erase(at + 1, end + 2 - at);
        }
    return text;
}

/// As the front leaves it: packings are added before passes run.
Compiled callisto(bool own_blocks)
{
    Compiled result;
    Diagnostics diagnostics;
    const auto add = [&](Sources& all, std::string_view module) {
        const std::string path = "models/" + std::string{module} + ".lobe";
        std::ifstream file{"../" + path};
        std::ostringstream text;
        text << file.rdbuf();
        return all.add(path, own_blocks ? text.str() : without_blocks(text.str()));
    };
    const std::uint32_t root = add(result.sources, "callisto");
    const check::Loader loader = [&](Sources& all, std::string_view module,
                                     std::string_view) -> std::optional<std::uint32_t> {
        return add(all, module);
    };
    auto module = front(result.sources, root, loader, diagnostics);
    INFO(render_text(result.sources, diagnostics));
    REQUIRE(module.has_value());
    result.module = std::move(*module);
    return result;
}

/// The engine's GBuffer as far as these tests go, under one configuration.
ir::Gbuffer gbuffer()
{
    ir::Gbuffer result;
    result.name = "stand_in";
    const auto add = [&](const std::string& target, const std::string& label,
                         const std::vector<std::array<std::string, 3>>& channels) {
        result.targets.push_back({target, label, {}, {}});
        for (const auto& [name, field, holder] : channels) {
            ir::Channel channel;
            channel.target = result.targets.size() - 1;
            channel.name = name;
            channel.label = field;
            channel.field = "GBuffer." + field;
            channel.formats = {{ir::Storage::unorm, 8}};
            channel.exists = {true};
            if (!holder.empty()) channel.holders.push_back({holder, holder, true, {true}, {}});
            result.channels.push_back(std::move(channel));
        }
    };
    add("b", "GBufferB",
        {{"r", "StoredMetallic", "metallic"}, {"g", "StoredSpecular", "specular"}});
    add("c", "GBufferC", {{"a", "GBufferAO", "ambient_occlusion"}});
    add("d", "GBufferD",
        {{"r", "CustomData.x", ""},
         {"g", "CustomData.y", ""},
         {"b", "CustomData.z", ""},
         {"a", "CustomData.w", ""}});
    add("f", "GBufferF", {{"a", "StoredAnisotropy", "anisotropy"}});
    const auto pin = [&](const std::string& name, const std::string& label) {
        result.pins.push_back({name, label, {}, 0, {}, {}});
    };
    pin("opacity", "Opacity");
    pin("anisotropy", "Anisotropy");
    pin("ambient_occlusion", "AmbientOcclusion");
    pin("metallic", "Metallic");
    pin("specular", "Specular");
    pin("custom_data0", "CustomData0");
    pin("custom_data1", "CustomData1");
    return result;
}

std::uint32_t parameter_of(const ir::Module& module, const std::string& name)
{
    const auto found = std::ranges::find(module.parameters, name, &ir::Parameter::name);
    INFO(name);
    REQUIRE(found != module.parameters.end());
    return static_cast<std::uint32_t>(found - module.parameters.begin());
}

ir::Packing packing(const ir::Module& module, const ir::Gbuffer& gbuffer, const Wish& wish)
{
    ir::Packing result;
    result.model = module.models.front();
    result.gbuffer = gbuffer.name;
    result.module = module.name;
    result.supported = {true};
    for (const Place& place : wish.places) {
        ir::Field field;
        field.parameter = parameter_of(module, place.parameter);
        field.component = place.component;
        const auto channel =
            gbuffer.find_channel(place.channel.substr(0, 1), place.channel.substr(2));
        REQUIRE(channel.has_value());
        field.slots = {{*channel, place.low, place.bits}};
        field.bits = place.bits;
        field.range = module.parameters[field.parameter].range;
        result.fields.push_back(std::move(field));
    }
    return result;
}

ir::Engine engine(const ir::Module& module, const ir::Gbuffer& gbuffer, const Wish& wish)
{
    ir::Engine result;
    result.gbuffer = gbuffer.name;
    result.model = module.models.front().name;
    result.module = module.name;
    result.shading_model = wish.shading_model;
    for (const auto& [pin, parameter] : wish.pins) {
        const auto index = gbuffer.find_pin(pin);
        REQUIRE(index.has_value());
        result.pins.push_back({*index, parameter_of(module, parameter), "", {}});
    }
    if (!wish.node.empty()) {
        result.node = ir::Engine::Node{wish.node, {}, {}};
        for (const std::string& parameter : wish.node_parameters)
            result.node->parameters.push_back(parameter_of(module, parameter));
    }
    if (!wish.color.empty()) result.color = wish.color;
    return result;
}

/// What its engine block and the packing of it say.
Wished finished(const Compiled& compiled)
{
    Wished result{middle(compiled.module), {}, {}};
    REQUIRE(!result.module.engines.empty());
    const ir::Engine& block = result.module.engines.front();
    const auto packing = emit::packing_of(result.module, block);
    REQUIRE(packing.has_value());
    const auto values = emit::engine_values(result.module, block, *packing);
    REQUIRE(values.has_value());
    result.values = *values;
    result.request = {values->model, values->values, values->words, {}};
    for (const emit::Artifact& file :
         back(result.module, compiled.sources, {emit::find_target("ue4")}))
        result.request.files.emplace_back(file.path.substr(file.path.rfind('/') + 1), file.text);
    return result;
}

}  // namespace

Wish plain_wish()
{
    Wish wish;
    wish.places = {{"diffuse_fresnel", "d.r"},
                   {"retroreflection", "d.g"},
                   {"diffuse_fresnel_falloff", "d.b", 4, 4},
                   {"retroreflection_falloff", "d.b", 0, 4},
                   {"smooth_terminator", "d.a", 3, 5},
                   {"specular_fresnel_falloff", "d.a", 0, 3}};
    wish.pins = {{"custom_data0", "diffuse_fresnel"},
                 {"custom_data1", "retroreflection"},
                 {"opacity", "diffuse_fresnel_falloff"}};
    wish.node = "CallistoAdvancedParams";
    wish.node_parameters = {"smooth_terminator", "specular_fresnel_falloff"};
    wish.color = {0.9, 0.25, 0.125};
    return wish;
}

Wish carrier_wish()
{
    Wish wish = plain_wish();
    wish.places[0].channel = "f.a";
    wish.places[1].channel = "b.r";
    wish.places.push_back({"dual_specular_opacity", "b.g"});
    wish.pins = {{"anisotropy", "diffuse_fresnel"},
                 {"custom_data1", "retroreflection"},
                 {"ambient_occlusion", "retroreflection_falloff"},
                 {"specular", "dual_specular_opacity"}};
    return wish;
}

Wish color_wish()
{
    Wish wish = plain_wish();
    wish.places = {{"diffuse_fresnel", "d.r"}};
    for (int i = 0; i < 3; ++i)
        wish.places.push_back({"diffuse_fresnel_tint", std::string{"d."} + "gba"[i], 0, 8, i});
    wish.pins = {};
    wish.node_parameters = {"diffuse_fresnel", "diffuse_fresnel_tint"};
    wish.color = {};
    return wish;
}

Wished wished(const Wish& wish)
{
    Compiled compiled = callisto(false);
    ir::Module& module = compiled.module;
    module.gbuffers = {gbuffer()};
    module.packings.push_back(packing(module, module.gbuffers.front(), wish));
    module.engines.push_back(engine(module, module.gbuffers.front(), wish));
    ir::build_functions(module, module.packings.front(), module.gbuffers.front());

    return finished(compiled);
}

Wished shipped() { return finished(callisto(true)); }

}  // namespace lobe::engine
