// What the edits are told of a model.
#include "engine/models.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <set>

namespace lobe::engine {
namespace {

std::set<std::string> words_of(const Wish& wish)
{
    const emit::EngineValues values = wished(wish).values;
    return {values.words.begin(), values.words.end()};
}

const std::string& text(const Wished& wished, std::string_view name)
{
    const std::string* found = wished.values.values.texts.find(name);
    INFO(name);
    REQUIRE(found != nullptr);
    return *found;
}

const std::vector<emit::Record>& list(const Wished& wished, std::string_view name)
{
    const auto* found = wished.values.values.lists.find(name);
    INFO(name);
    REQUIRE(found != nullptr);
    return *found;
}

}  // namespace

TEST_CASE("words say what is there")
{
    const std::set<std::string> plain{"has_color",    "has_node",          "any_pin",
                                      "pin_opacity",  "pin_custom_data0",  "pin_custom_data1",
                                      "lent_opacity", "lent_custom_data0", "lent_custom_data1",
                                      "carrier_d_r",  "carrier_d_g",       "carrier_d_b",
                                      "carrier_d_a"};
    CHECK(words_of(plain_wish()) == plain);

    const std::set<std::string> carrier = words_of(carrier_wish());
    for (const std::string word :
         {"carrier_f_a", "carrier_b_r", "carrier_b_g", "pin_anisotropy", "lent_anisotropy",
          "lent_metallic", "lent_specular", "lent_ambient_occlusion", "stray_b_r"}) {
        CAPTURE(word);
        CHECK(carrier.contains(word));
    }
    // Their own pins feed what these carry.
    CHECK_FALSE(carrier.contains("stray_f_a"));
    CHECK_FALSE(carrier.contains("stray_b_g"));
    // Nothing of the engine's is in GBufferD.
    CHECK_FALSE(carrier.contains("stray_d_g"));
}

TEST_CASE("a model's name is one in every language")
{
    Wish wish = plain_wish();
    wish.shading_model = "Skin & \"Hair\"";
    const Wished result = wished(wish);
    CHECK(result.values.model == "SkinHair");
    CHECK(text(result, "Model") == "SkinHair");
    CHECK(text(result, "MODEL") == "SKINHAIR");
    CHECK(text(result, "display") == R"("Skin & \"Hair\"")");
}

TEST_CASE("functions and files are those that are emitted")
{
    const Wished result = wished(plain_wish());
    const auto file = [&](std::string_view name) {
        const auto found = std::ranges::find(result.request.files, text(result, name),
                                             [](const auto& each) { return each.first; });
        REQUIRE(found != result.request.files.end());
        return found->second;
    };
    CHECK(file("shader_file").find("FDirectLighting " + text(result, "bxdf") + "(") !=
          std::string::npos);
    CHECK(file("packing_file").find("void " + text(result, "pack") + "(") != std::string::npos);
}

TEST_CASE("every packed parameter is fed once, or has its default")
{
    const Wished result = wished(plain_wish());
    std::multiset<std::string> locals;
    const auto add = [&](const std::vector<emit::Record>& records) {
        for (const emit::Record& record : records) locals.insert(record.texts.at("local"));
    };
    add(list(result, "pins"));
    add(list(result, "nodes").front().lists.at("inputs"));
    add(list(result, "unfed"));
    CHECK(list(result, "unfed").size() == 1);
    CHECK(locals == std::multiset<std::string>{
                        "CallistoDiffuseFresnel", "CallistoRetroreflection",
                        "CallistoDiffuseFresnelFalloff", "CallistoRetroreflectionFalloff",
                        "CallistoSmoothTerminator", "CallistoSpecularFresnelFalloff"});
    for (const std::string& local : locals)
        CHECK(text(result, "pack_arguments").find(local) != std::string::npos);
}

TEST_CASE("colors are three numbers, in shaders and in C++")
{
    const Wished result = wished(color_wish());
    const emit::Record& input = list(result, "inputs").at(1);
    CHECK(input.texts.at("name") == "DiffuseFresnelTint");
    CHECK(input.lists.at("number").empty());
    CHECK(input.lists.at("color").front().texts.at("g") == "1.0f");
    const emit::Record& fed = list(result, "nodes").front().lists.at("inputs").at(1);
    CHECK(fed.texts.at("type") == "float3");
    CHECK(fed.texts.at("value") == "float3( 1.0, 1.0, 1.0 )");
}

TEST_CASE("equal models give equal values")
{
    const emit::Record first = wished(carrier_wish()).values.values;
    const emit::Record second = wished(carrier_wish()).values.values;
    REQUIRE(std::distance(first.texts.begin(), first.texts.end()) ==
            std::distance(second.texts.begin(), second.texts.end()));
    for (const auto& field : first.texts) CHECK(second.texts.at(field.name) == field.value);
}

}  // namespace lobe::engine
