// What a scene is before it is glTF: JSON, a .glb container, URIs; and how much is told.
#include "scene/json.h"
#include "scene/reading.h"
#include "scene/uri.h"

#include <catch2/catch.hpp>
#include <fmt/format.h>

using namespace lobe;
using namespace lobe::tests;

namespace {

std::string refusal(std::string_view bytes)
{
    const auto result = read_bytes(bytes);
    CHECK_FALSE(result.scene);
    return told(result.complaints);
}

std::string nested(std::size_t levels)
{
    return R"({"asset": {"version": "2.0"}, "extras": )" + std::string(levels, '[') +
           std::string(levels, ']') + "}";
}

std::string chunk(std::uint32_t type, const std::string& data)
{
    return pack<std::uint32_t>({static_cast<std::uint32_t>(data.size()), type}) + data;
}

std::string glb(const std::string& chunks, std::uint32_t version = 2)
{
    return "glTF" + pack<std::uint32_t>({version, static_cast<std::uint32_t>(12 + chunks.size())}) +
           chunks;
}

constexpr std::uint32_t json_type = 0x4E4F534A;
constexpr std::uint32_t binary_type = 0x004E4942;
const std::string least = R"({"asset":{"version":"2.0"}} )";  // 28 bytes

std::string path_of(std::string_view uri)
{
    const auto resolved = scene::resolve(uri);
    if (const auto* file = std::get_if<scene::FilePath>(&resolved)) return file->path;
    if (const auto* bad = std::get_if<scene::BadUri>(&resolved)) return "! " + bad->message;
    return "= " + std::get<scene::InlineBytes>(resolved).bytes;
}

}  // namespace

TEST_CASE("the least scene is one without anything but the default material")
{
    const auto scene = read_clean(empty_document());
    CHECK(scene.path == "test.gltf");
    REQUIRE(scene.materials.size() == 1);
    CHECK(scene.materials[0].base_color.low == std::vector<double>{1, 1, 1, 1});
    CHECK(scene.materials[0].metallic.low == std::vector<double>{1});
    CHECK(scene.materials[0].roughness.low == std::vector<double>{1});
    CHECK_FALSE(scene.materials[0].roughness.is_given);
    CHECK(scene.shown_materials() == std::vector<std::size_t>{0});
    CHECK(scene.coverage() == std::vector<double>{1});
}

TEST_CASE("broken JSON is told by line, column and pointer")
{
    CHECK(refusal("") == "error : this is no JSON at line 1, column 1: unexpected end of input; "
                         "expected '[', '{', or a literal\n");
    CHECK(refusal("[]") == "error : an object is expected here, this is an array\n");
    CHECK(refusal("{\"asset\": {\"version\":\n \"2.0\"") ==
          "error /asset: this is no JSON at line 2, column 7: unexpected end of input; expected "
          "'}'\n");
    CHECK(
        refusal("{\"nodes\": [{}, {\"mesh\": }]}") ==
        "error /nodes/1/mesh: this is no JSON at line 1, column 25: unexpected '}'; expected '[', "
        "'{', or a literal\n");
    CHECK(refusal("{} x") == "error : this is no JSON at line 1, column 4: invalid literal\n");
    CHECK(refusal("{\"a\": \"\xC3(\"}") ==
          "error /a: this is no JSON at line 1, column 9: invalid string: ill-formed UTF-8 byte\n");
    CHECK(refusal("\xEF\xBB\xBF{}") == "error : a byte order mark comes before the JSON\n");
}

TEST_CASE("a member that is given twice is told")
{
    CHECK(refusal(R"({"nodes": [{}, {"a/b~": 1, "a/b~": 2}]})") ==
          "error /nodes/1/a~1b~0: `a/b~` is given twice\n");
}

TEST_CASE("a number beyond 64 bits is told at its pointer")
{
    CHECK(refusal(R"({"nodes": [{"scale": [1, 1e999, 1]}]})") ==
          "error /nodes/0/scale/1: this number is not finite in 64 bits (line 1, column 30)\n");
    CHECK(refusal(R"({"a": -1e999})") ==
          "error /a: this number is not finite in 64 bits (line 1, column 12)\n");
    CHECK(refusal(R"({"a": NaN})") ==
          "error /a: this is no JSON at line 1, column 7: invalid literal\n");
}

TEST_CASE("depth is limited, whatever the stack would take")
{
    const std::size_t deepest = scene::deepest_json - 1;  // the object around is a level too
    CHECK(read_bytes(nested(deepest)).scene);
    const std::string message = refusal(nested(1'000'000));
    CHECK(message == refusal(nested(deepest + 1)));
    CHECK(message.ends_with(fmt::format("more than {} levels deep\n", scene::deepest_json)));
    CHECK(message.starts_with("error /extras/0/0/0/"));
}

TEST_CASE("at most a hundred complaints are told, and how many more there are")
{
    auto document = empty_document();
    for (int material = 0; material < 250; ++material) document["materials"].push_back(material);
    const auto result = read(document);
    REQUIRE(result.complaints.size() == 101);
    CHECK(result.complaints[99].pointer == "/materials/99");
    CHECK(result.complaints[100].message == "150 more");
    CHECK(result.complaints[100].is_error);
}

TEST_CASE("a .glb file is its chunks")
{
    CHECK(read_bytes(glb(chunk(json_type, least))).scene);
    CHECK(read_bytes(glb(chunk(json_type, least) + chunk(binary_type, "    "))).scene);
    const std::string other = chunk(0x12345678, "12345678");
    CHECK(read_bytes(glb(chunk(json_type, least) + chunk(binary_type, "    ") + other)).scene);
    CHECK(read_bytes(glb(chunk(json_type, least) + other)).scene);
}

TEST_CASE("the first buffer of a .glb file is its binary chunk")
{
    const std::string text = R"({"asset":{"version":"2.0"},"buffers":[{"byteLength":3}],)"
                             R"("bufferViews":[{"buffer":0,"byteLength":3}]})";
    const std::string padded = text + std::string((4 - text.size() % 4) % 4, ' ');
    CHECK(
        read_bytes(glb(chunk(json_type, padded) + chunk(binary_type, std::string(4, '\0')))).scene);
    CHECK(refusal(glb(chunk(json_type, padded))) ==
          "error /buffers/0: this buffer has no `uri` (only the first buffer of a .glb file may "
          "leave it out)\n");
}

TEST_CASE("a broken .glb file is told")
{
    const std::string good = glb(chunk(json_type, least));
    CHECK(refusal("glTF\x02") == "error : the header of this .glb file is cut off\n");
    CHECK(refusal(glb(chunk(json_type, least), 1)) ==
          "error : this .glb file is of version 1; 2 is read\n");
    CHECK(refusal(good.substr(0, good.size() - 1)) ==
          "error : this .glb file gives its length as 48 bytes, and has 47\n");
    CHECK(refusal(glb("")) == "error : this .glb file has no chunk\n");
    CHECK(refusal(glb("JSON")) == "error : chunk 0 of this .glb file is cut off\n");
    CHECK(refusal(glb(pack<std::uint32_t>({0xFFFFFFFC, json_type}) + least)) ==
          "error : chunk 0 of this .glb file has 4294967292 bytes, and 28 are left\n");
    CHECK(refusal(glb(chunk(json_type, least + "  "))) ==
          "error : chunk 0 of this .glb file has 30 bytes, no multiple of 4\n");
    CHECK(refusal(glb(chunk(binary_type, "    "))) ==
          "error : the first chunk of this .glb file is not its JSON\n");
    CHECK(refusal(glb(chunk(json_type, least) + chunk(json_type, least))) ==
          "error : chunk 1 of this .glb file is out of its place\n");
}

TEST_CASE("a URI names a file below the scene's folder, or holds bytes")
{
    CHECK(path_of("a.bin") == "a.bin");
    CHECK(path_of("./textures//a%20b%C3%A9.png") == "textures/a b\xC3\xA9.png");
    CHECK(path_of("a/../b.png") == "b.png");
    CHECK(path_of("a/..b") == "a/..b");
    CHECK(path_of("data:;base64,aGk=") == "= hi");
    CHECK(path_of("data:image/png;base64,aGk") == "= hi");
    CHECK(path_of("data:a/b;base64,") == "= ");

    CHECK(path_of("../a") == "! this path leaves the scene's folder");
    CHECK(path_of("a/%2e%2e/../b") == "! this path leaves the scene's folder");
    CHECK(path_of("/etc/passwd") == "! this path is absolute");
    CHECK(path_of("%2Fetc/passwd") == "! this path is absolute");
    CHECK(path_of("//host/a") == "! this path is absolute");
    CHECK(path_of("https://host/a") == "! this URI has a scheme, and only files are read");
    CHECK(path_of("file:a") == "! this URI has a scheme, and only files are read");
    CHECK(path_of("C%3A/a") == "! the first folder of this path has a colon");
    CHECK(path_of("a\\b") == "! this path has a backslash or a control character");
    CHECK(path_of("a%00b") == "! this path has a backslash or a control character");
    CHECK(path_of("a%2") == "! a `%` in this URI has no two hexadecimal digits behind it");
    CHECK(path_of("a%zz") == "! a `%` in this URI has no two hexadecimal digits behind it");
    CHECK(path_of("") == "! this path names no file");
    CHECK(path_of("a/..") == "! this path names no file");
    CHECK(path_of("data:hello") == "! this data URI has no comma before its data");
    CHECK(path_of("data:,hello") == "! this data URI is not in base64");
    CHECK(path_of("data:;base64,a") == "! the data of this URI are no base64");
    CHECK(path_of("data:;base64,aG k") == "! the data of this URI are no base64");
}

TEST_CASE("a file that the scene names comes by its decoded path")
{
    auto document = empty_document();
    document["buffers"] = {{{"byteLength", 3}, {"uri", "sub/./my%20data.bin"}}};
    CHECK(read(document, {{"sub/my data.bin", "abc"}}).scene);
    CHECK_FALSE(read(document, {{"sub/my%20data.bin", "abc"}}).scene);
}
