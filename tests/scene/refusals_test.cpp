// Every complaint, with its pointer: one of everything, with one thing changed.
#include "scene/reading.h"

#include <catch2/catch.hpp>

using namespace lobe;
using namespace lobe::tests;
using nlohmann::json;

namespace {

struct Change {
    std::string at;     ///< pointer of what is changed
    std::string value;  ///< JSON; empty: the member is removed
    std::string told;   ///< the one complaint
};

Files one_picture() { return {{"one.png", slurp("plates_color.png")}}; }

void remove(json& from, const std::string& name)
{
    if (from.is_array())
        from.erase(std::stoul(name));
    else
        from.erase(name);
}

void expect(const Change& change)
{
    json document = one_of_everything();
    // The faces of the environment have the size of the one picture.
    document["extensions"]["EXT_lights_image_based"]["lights"][0]["specularImageSize"] = 16;
    const json::json_pointer at{change.at};
    if (change.value.empty())
        remove(document[at.parent_pointer()], at.back());
    else
        document[at] = json::parse(change.value);
    CAPTURE(change.at, change.value);
    const auto result = read(document, one_picture());
    CHECK(told(result.complaints) == change.told + "\n");
    CHECK_FALSE(result.scene);
}

}  // namespace

TEST_CASE("one of everything is read without a complaint")
{
    json document = one_of_everything();
    document["extensions"]["EXT_lights_image_based"]["lights"][0]["specularImageSize"] = 16;
    const auto scene = read_clean(document, one_picture());
    CHECK(scene.materials.size() == 2);
    CHECK(scene.instances.size() == 1);
    CHECK(scene.lights.size() == 1);
    CHECK(scene.cameras.size() == 1);
    CHECK(scene.environment);
}

TEST_CASE("what is wrong with the file as a whole is told")
{
    expect({"/asset", "", "error : `asset` is missing"});
    expect({"/asset", "[]", "error /asset: an object is expected here, this is an array"});
    expect({"/asset/version", "", "error /asset: `version` is missing"});
    expect({"/asset/version", "2",
            "error /asset/version: a string is expected here, this is a number"});
    expect({"/asset/version", "\"1.0\"", "error /asset/version: glTF 2 is read, this is `1.0`"});
    expect({"/asset/version", "\"two\"", "error /asset/version: glTF 2 is read, this is `two`"});
    expect({"/asset/minVersion", "\"2.1\"",
            "error /asset/minVersion: glTF 2.0 is read, `2.1` is needed"});
    expect({"/extensionsRequired/0", "\"KHR_draco_mesh_compression\"",
            "error /extensionsRequired/0: extension `KHR_draco_mesh_compression` is required, and "
            "not known"});
    expect({"/extensionsRequired/0", "\"KHR_materials_sheen\"",
            "error /extensionsRequired/0: extension `KHR_materials_sheen` is missing in "
            "`extensionsUsed`"});
    expect({"/extensionsUsed/1", "7",
            "error /extensionsUsed/1: a string is expected here, this is a number"});
}

TEST_CASE("what is wrong with buffers, views and accessors is told")
{
    expect({"/buffers/0/byteLength", "", "error /buffers/0: `byteLength` is missing"});
    expect({"/buffers/0/byteLength", "0",
            "error /buffers/0/byteLength: 0 is no whole number of at least 1 and at most "
            "281474976710656"});
    expect({"/buffers/0/byteLength", "37",
            "error /buffers/0: 36 bytes are here, and `byteLength` is 37"});
    expect({"/buffers/0/uri", "",
            "error /buffers/0: this buffer has no `uri` (only the first buffer of a .glb file may "
            "leave it out)"});
    expect({"/buffers/0/uri", "\"none.bin\"",
            "error /buffers/0/uri: this buffer cannot be read: `none.bin`: no such file"});
    expect({"/buffers/0/uri", "null",
            "error /buffers/0/uri: a string is expected here, this is null"});
    expect({"/buffers/0/uri", "\"data:application/octet-stream;base64,AA*A\"",
            "error /buffers/0/uri: the data of this URI are no base64"});
    expect({"/bufferViews/0/buffer", "3",
            "error /bufferViews/0/buffer: 3 is past the end of `buffers`, which has 3"});
    expect({"/bufferViews/0/buffer", "-1",
            "error /bufferViews/0/buffer: an index into `buffers` is expected here, this is a "
            "number"});
    expect({"/bufferViews/0/byteLength", "37",
            "error /bufferViews/0: bytes 0 to 37 are asked of a buffer of 36"});
    expect({"/bufferViews/0/byteOffset", "281474976710656",
            "error /bufferViews/0: bytes 281474976710656 to 281474976710692 are asked of a buffer "
            "of 36"});
    expect({"/bufferViews/0/byteStride", "14",
            "error /bufferViews/0: a `byteStride` of 14 is no multiple of 4"});
    expect(
        {"/bufferViews/0/byteStride", "8", "error /accessors/0: elements of 12 bytes are 8 apart"});
    expect(
        {"/bufferViews/0/byteStride", "16",
         "error /accessors/0: 3 elements of 12 bytes, 16 apart, do not fit from byte 0 on into a "
         "buffer view of 36 bytes"});
    expect({"/accessors/0/count", "", "error /accessors/0: `count` is missing"});
    expect(
        {"/accessors/0/count", "1099511627776",
         "error /accessors/0: 1099511627776 elements of 12 bytes, 12 apart, do not fit from byte "
         "0 on into a buffer view of 36 bytes"});
    expect({"/accessors/0/count", "2.5",
            "error /accessors/0/count: 2.5 is no whole number of at least 1 and at most "
            "1099511627776"});
    expect(
        {"/accessors/0/type", "\"VEC5\"",
         "error /accessors/0/type: `VEC5` is none of SCALAR, VEC2, VEC3, VEC4, MAT2, MAT3, MAT4"});
    expect({"/accessors/0/componentType", "5124",
            "error /accessors/0/componentType: 5124 is no component type"});
    expect(
        {"/accessors/0/componentType", "5130",
         "error /accessors/0/componentType: 5130 is no whole number of at least 5120 and at most "
         "5126"});
    expect({"/accessors/0/normalized", "true",
            "error /accessors/0: only components of 8 and 16 bits are normalized"});
    expect({"/accessors/0/normalized", "1",
            "error /accessors/0/normalized: true or false is expected here, this is a number"});
    expect({"/accessors/0/byteOffset", "2",
            "error /accessors/0: components of 4 bytes begin at byte 2 of the buffer"});
    expect({"/accessors/0/bufferView", "9",
            "error /accessors/0/bufferView: 9 is past the end of `bufferViews`, which has 3"});
    expect({"/accessors/0/sparse",
            R"({"count": 1, "indices": {"bufferView": 2, "componentType": 5123}})",
            "error /accessors/0/sparse: `values` is missing"});
    expect({"/accessors/0/sparse",
            R"({"count": 1, "indices": {"bufferView": 2, "componentType": 5122},
                                       "values": {"bufferView": 0}})",
            "error /accessors/0/sparse/indices: indices are unsigned integers"});
    expect({"/accessors/0/sparse",
            R"({"count": 4, "indices": {"bufferView": 2, "componentType": 5123},
                                       "values": {"bufferView": 0}})",
            "error /accessors/0/sparse/count: 4 is no whole number of at least 1 and at most 3"});
    expect({"/accessors/0/sparse",
            R"({"count": 2, "indices": {"bufferView": 1, "componentType": 5121},
                                       "values": {"bufferView": 0}})",
            "error /accessors/0/sparse/indices: index 0 comes after a larger or equal one"});
    expect(
        {"/accessors/0/sparse", R"({"count": 1, "indices": {"bufferView": 1, "componentType": 5121,
                                       "byteOffset": 2}, "values": {"bufferView": 0}})",
         "error /accessors/0/sparse/indices: index 255 is past the accessor's end, which has 3"});
}

TEST_CASE("what is wrong with meshes is told")
{
    const std::string primitive = "/meshes/0/primitives/0";
    expect({"/meshes/0/primitives", "", "error /meshes/0: `primitives` is missing"});
    expect({primitive + "/attributes", "", "error " + primitive + ": `attributes` is missing"});
    expect({primitive + "/attributes/POSITION", "5",
            "error " + primitive +
                "/attributes/POSITION: 5 is past the end of `accessors`, which has 3"});
    expect(
        {primitive + "/attributes/POSITION", "1",
         "error " + primitive + "/attributes/POSITION: POSITION takes no accessor of this type"});
    expect({primitive + "/attributes/NORMAL", "1",
            "error " + primitive + "/attributes/NORMAL: NORMAL takes no accessor of this type"});
    expect({primitive + "/indices", "1",
            "error " + primitive + "/indices: accessor 1 has no unsigned integers"});
    expect({primitive + "/material", "2",
            "error " + primitive + "/material: 2 is past the end of `materials`, which has 2"});
    expect({primitive + "/mode", "7",
            "error " + primitive + "/mode: 7 is no whole number of at least 0 and at most 6"});
    expect({"/accessors/0/count", "2",
            "error " + primitive +
                "/attributes/TEXCOORD_0: 3 elements, where another attribute has 2"});
}

TEST_CASE("what is wrong with materials and textures is told")
{
    const std::string base = "/materials/0/pbrMetallicRoughness";
    expect(
        {"/materials/1", "3", "error /materials/1: an object is expected here, this is a number"});
    expect({"/materials/0/name", "[]",
            "error /materials/0/name: a string is expected here, this is an array"});
    expect({base + "/metallicFactor", "1.5",
            "error " + base +
                "/metallicFactor: 1.5 is outside what it may be: at least 0 and at "
                "most 1"});
    expect({base + "/roughnessFactor", "-0.5",
            "error " + base +
                "/roughnessFactor: -0.5 is outside what it may be: at least 0 and at "
                "most 1"});
    expect({base + "/baseColorFactor", "[1, 1, 1]",
            "error " + base +
                "/baseColorFactor: an array of 4 numbers is expected here, this is an array"});
    expect({base + "/baseColorFactor/2", "\"x\"",
            "error " + base + "/baseColorFactor/2: a number is expected here, this is a string"});
    expect({base + "/baseColorTexture/index", "",
            "error " + base + "/baseColorTexture: `index` is missing"});
    expect({base + "/baseColorTexture/index", "1",
            "error " + base +
                "/baseColorTexture/index: 1 is past the end of `textures`, which has 1"});
    expect(
        {base + "/baseColorTexture/texCoord", "-1",
         "error " + base +
             "/baseColorTexture/texCoord: -1 is no whole number of at least 0 and at most 1000"});
    expect({base + "/baseColorTexture/extensions/KHR_texture_transform/scale", "[1]",
            "error " + base +
                "/baseColorTexture/extensions/KHR_texture_transform/scale: an array of 2 numbers "
                "is expected here, this is an array"});
    expect({"/materials/0/alphaMode", "\"mask\"",
            "error /materials/0/alphaMode: `mask` is none of OPAQUE, MASK, BLEND"});
    expect({"/materials/0/alphaCutoff", "-1",
            "error /materials/0/alphaCutoff: -1 is outside what it may be: at least 0"});
    expect({"/materials/0/doubleSided", "\"yes\"",
            "error /materials/0/doubleSided: true or false is expected here, this is a string"});
    expect({"/materials/0/occlusionTexture/strength", "2",
            "error /materials/0/occlusionTexture/strength: 2 is outside what it may be: at least 0 "
            "and at most 1"});
    expect({"/materials/0/extensions/KHR_materials_ior/ior", "0.5",
            "error /materials/0/extensions/KHR_materials_ior/ior: an index of refraction is at "
            "least 1, or 0 for none"});
    expect({"/materials/0/extensions/KHR_materials_ior", "1.4",
            "error /materials/0/extensions/KHR_materials_ior: an object is expected here, this is "
            "a number"});
    expect({"/materials/0/extensions/KHR_materials_clearcoat", "[]",
            "error /materials/0/extensions/KHR_materials_clearcoat: an object is expected here, "
            "this is an array"});
    expect({"/materials/0/normalTexture", "0",
            "error /materials/0/normalTexture: an object is expected here, this is a number"});
    expect({"/textures/0/source", "1",
            "error /textures/0/source: 1 is past the end of `images`, which has 1"});
    expect({"/textures/0/sampler", "1",
            "error /textures/0/sampler: 1 is past the end of `samplers`, which has 1"});
    expect({"/samplers/0/wrapS", "1", "error /samplers/0/wrapS: 1 is none of 10497, 33648, 33071"});
    expect({"/images/0/uri", "", "error /images/0: one of `uri` and `bufferView` is missing"});
    expect({"/images/0/bufferView", "0", "error /images/0: `uri` and `bufferView` are given"});
    expect({"/images/0/uri", "\"../one.png\"",
            "error /images/0/uri: this path leaves the scene's folder (name a file below the "
            "scene's folder by a relative path)"});
}

TEST_CASE("what is wrong with a model's own parameters is told")
{
    const std::string lobe = "/materials/0/extras/lobe";
    const std::string parameters = lobe + "/parameters";
    expect({lobe + "/parameter", "{}",
            "error " + lobe +
                "/parameter: `parameter` is not known here (did you mean `parameters`?)"});
    expect({lobe + "/something", "{}",
            "error " + lobe +
                "/something: `something` is not known here (known are layers, parameters)"});
    expect({parameters, "3",
            "error " + parameters + ": an object is expected here, this is a number"});
    expect({parameters + "/constant", "\"2\"",
            "error " + parameters + "/constant: a number is expected here, this is a string"});
    expect({parameters + "/color", "[]",
            "error " + parameters + "/color: 0 numbers; a parameter has 1 to 4"});
    expect({parameters + "/color/1", "true",
            "error " + parameters + "/color/1: a number is expected here, this is true or false"});
    expect({parameters + "/ranged/max", "", "error " + parameters + "/ranged: `max` is missing"});
    expect({parameters + "/ranged/min", "2",
            "error " + parameters + "/ranged: `min` 2 is above `max` 1"});
    expect({parameters + "/ranged/max", "[1, 2]",
            "error " + parameters + "/ranged/max: 2 numbers for 1 components"});
    expect({parameters + "/ranged/mix", "1",
            "error " + parameters + "/ranged/mix: `mix` is not known here (did you mean `max`?)"});
    expect(
        {parameters + "/shown/texture", "0",
         "error " + parameters + "/shown/texture: an object is expected here, this is a number"});
    expect({parameters + "/shown/texture/index", "8",
            "error " + parameters +
                "/shown/texture/index: 8 is past the end of `textures`, which has 1"});
    expect({parameters + "/shown/texture/channel", "\"x\"",
            "error " + parameters + "/shown/texture/channel: a channel is one letter of `rgba`"});
    expect({parameters + "/shown/texture/channels", "\"rgb\"",
            "error " + parameters + "/shown/texture: `channel` and `channels` are given"});
    expect({parameters + "/shown/texture/chanel", "\"r\"",
            "error " + parameters +
                "/shown/texture/chanel: `chanel` is not known here (did you mean `channel`?)"});
    expect({parameters + "/shown/scale", "[1, 2]",
            "error " + parameters + "/shown/scale: 2 numbers for 1 components"});
    expect(
        {parameters + "/shown/scal", "1",
         "error " + parameters + "/shown/scal: `scal` is not known here (did you mean `scale`?)"});
    expect({lobe + "/layers/0/material", "2",
            "error " + lobe + "/layers/0/material: 2 is past the end of `materials`, which has 2"});
    expect({lobe + "/layers/0/weight", "", "error " + lobe + "/layers/0: `weight` is missing"});
    expect({lobe + "/layers/0/weight", "1.5",
            "error " + lobe +
                "/layers/0/weight: 1.5 is outside what a weight may be: at least 0 and at most 1"});
    expect({lobe + "/layers/0/weight", R"({"texture": {"index": 0}, "scale": 0.5, "offset": 0.75})",
            "error " + lobe +
                "/layers/0/weight: 0.75 to 1.25 is outside what a weight may be: at least 0 and at "
                "most 1"});
    expect({lobe + "/layers/0/weight", "[0.5, 0.5]",
            "error " + lobe + "/layers/0/weight: a weight is one number"});
    expect({lobe + "/layers/0/material", "0",
            "error " + lobe + "/layers: these layers lead to a material that lies over itself"});
}

TEST_CASE("what is wrong with lights is told")
{
    const std::string lights = "/extensions/KHR_lights_punctual/lights";
    expect({lights + "/0/type", "", "error " + lights + "/0: `type` is missing"});
    expect({lights + "/0/type", "\"area\"",
            "error " + lights + "/0/type: `area` is none of directional, point, spot"});
    expect(
        {lights + "/0/color/0", "2",
         "error " + lights + "/0/color/0: 2 is outside what it may be: at least 0 and at most 1"});
    expect({lights + "/0/intensity", "-1",
            "error " + lights + "/0/intensity: -1 is outside what it may be: at least 0"});
    expect({lights + "/0/range", "0",
            "error " + lights + "/0/range: 0 is outside what it may be: above 0"});
    expect({lights + "/0/spot", "", "error " + lights + "/0: `spot` is missing"});
    expect({lights + "/0/spot/innerConeAngle", "0.2",
            "error " + lights +
                "/0/spot: the inner cone's angle 0.2 is not below the outer one's 0.2"});
    expect({lights + "/0/type", "\"directional\"",
            "error " + lights + "/0/range: a directional light has no range"});
    expect({lights + "/1/extras/lobe/radius", "",
            "error " + lights + "/1/extras/lobe: `radius` is missing"});
    expect({lights + "/1/extras/lobe/radius", "0",
            "error " + lights + "/1/extras/lobe/radius: 0 is outside what it may be: above 0"});
    expect({lights + "/1/extras/lobe/lenght", "1",
            "error " + lights +
                "/1/extras/lobe/lenght: `lenght` is not known here (did you mean `length`?)"});
    expect({lights + "/0/extras", R"({"lobe": {"radius": 1}})",
            "error " + lights + "/0/extras/lobe: only a point light has a size"});
}

TEST_CASE("what is wrong with environments is told")
{
    const std::string light = "/extensions/EXT_lights_image_based/lights/0";
    expect({light + "/irradianceCoefficients", "",
            "error " + light + ": `irradianceCoefficients` is missing"});
    expect({light + "/irradianceCoefficients/8", "",
            "error " + light + "/irradianceCoefficients: 8 coefficients; bands 0 to 2 have 9"});
    expect({light + "/irradianceCoefficients/3/1", "{}",
            "error " + light +
                "/irradianceCoefficients/3/1: a number is expected here, this is an object"});
    expect({light + "/specularImages/0/5", "",
            "error " + light + "/specularImages/0: a mip has six faces"});
    expect({light + "/specularImages/0/5", "1",
            "error " + light + "/specularImages/0/5: 1 is past the end of `images`, which has 1"});
    expect(
        {light + "/rotation", "[0, 2, 0, 0]",
         "error " + light + "/rotation: a rotation is a unit quaternion; this one has length 2"});
    expect({"/scenes/0/extensions/EXT_lights_image_based/light", "1",
            "error /scenes/0/extensions/EXT_lights_image_based/light: 1 is past the end of "
            "`lights`, which has 1"});
}

TEST_CASE("a face of another size is told")
{
    const auto result = read(one_of_everything(), one_picture());
    const std::string faces = "/extensions/EXT_lights_image_based/lights/0/specularImages/0/";
    std::string expected;
    for (const char* face : {"0", "1", "2", "3", "4", "5"})
        expected += "error " + faces + face +
                    ": this picture has 16 x 16 texels; a face of mip 0 has 1 x 1\n";
    CHECK(told(result.complaints) == expected);
}

TEST_CASE("what is wrong with nodes, cameras and scenes is told")
{
    expect({"/scene", "1", "error /scene: 1 is past the end of `scenes`, which has 1"});
    expect({"/scenes/0/nodes/0", "1", "error /scenes/0/nodes/0: node 1 is a child, and no root"});
    expect({"/scenes/0/nodes", "[0, 0]", "error /scenes/0/nodes: node 0 is listed twice"});
    expect({"/scenes/0/nodes", "[3]",
            "error /scenes/0/nodes/0: 3 is past the end of `nodes`, which has 3"});
    expect(
        {"/nodes/0/children", "[1, 2, 1]", "error /nodes/0/children/2: node 1 is a child already"});
    expect({"/nodes/1/children", "[0]",
            "error /nodes/0: this node is its own ancestor, or below one that is\nerror "
            "/scenes/0/nodes/0: node 0 is a child, and no root"});
    expect(
        {"/nodes/1/mesh", "1", "error /nodes/1/mesh: 1 is past the end of `meshes`, which has 1"});
    expect({"/nodes/1/matrix/0", "\"1\"",
            "error /nodes/1/matrix/0: a number is expected here, this is a string"});
    expect({"/nodes/1/scale", "[1, 1, 1]",
            "error /nodes/1/matrix: `matrix` stands beside `translation`, `rotation` or `scale`"});
    expect({"/nodes/0/rotation", "[0, 0, 0, 0.5]",
            "error /nodes/0/rotation: a rotation is a unit quaternion; this one has length 0.5"});
    expect({"/nodes/0/translation", "[1e300, 0, 0]",
            "error /nodes/0: in the world this node is beyond 1e+30"});
    expect({"/nodes/2/camera", "2",
            "error /nodes/2/camera: 2 is past the end of `cameras`, which has 2"});
    expect({"/nodes/2/extensions/KHR_lights_punctual/light", "",
            "error /nodes/2/extensions/KHR_lights_punctual: `light` is missing"});
    expect({"/nodes/2/extensions/KHR_lights_punctual/light", "2",
            "error /nodes/2/extensions/KHR_lights_punctual/light: 2 is past the end of `lights`, "
            "which has 2"});
    expect({"/cameras/0/type", "", "error /cameras/0: `type` is missing"});
    expect({"/cameras/0/perspective", "", "error /cameras/0: `perspective` is missing"});
    expect({"/cameras/0/perspective/yfov", "4",
            "error /cameras/0/perspective/yfov: 4 is outside what it may be: above 0 and below "
            "3.141592653589793"});
    expect({"/cameras/0/perspective/zfar", "0.05",
            "error /cameras/0/perspective/zfar: 0.05 is outside what it may be: above 0.1"});
    expect(
        {"/cameras/1/orthographic/ymag", "", "error /cameras/1/orthographic: `ymag` is missing"});
    expect({"/cameras/1/orthographic/xmag", "0",
            "error /cameras/1/orthographic/xmag: 0 is outside what it may be: above 0"});
}
