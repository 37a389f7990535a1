// A packing in every form: the same values everywhere, pictures that fit, bytes that stay.
#include "packing_sample.h"
#include "report/packing.h"
#include "report/packing_layout.h"
#include "report/packing_plot.h"

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <sstream>

using Catch::Contains;
using namespace lobe;

namespace {

/// Compares with a file of tests/report/golden; with LOBE_REWRITE set it is written instead.
void check_golden(const std::string& name, const std::string& text)
{
    const std::string path = "report/golden/" + name;
    if (std::getenv("LOBE_REWRITE") != nullptr) std::ofstream{path, std::ios::binary} << text;
    std::ifstream in{path, std::ios::binary};
    const std::string golden{std::istreambuf_iterator<char>{in}, {}};
    CAPTURE(path);
    CHECK(text == golden);
}

std::size_t count(const std::string& text, const std::string& part)
{
    std::size_t found = 0;
    for (std::size_t at = 0; (at = text.find(part, at)) != std::string::npos; at += part.size())
        ++found;
    return found;
}

std::string without_color(std::string text)
{
    for (std::size_t at; (at = text.find('\x1b')) != std::string::npos;)
        text.erase(at, text.find('m', at) - at + 1);
    return text;
}

std::size_t longest_line(const std::string& text)
{
    std::istringstream in{text};
    std::size_t longest = 0;
    for (std::string line; std::getline(in, line);) longest = std::max(longest, line.size());
    return longest;
}

}  // namespace

TEST_CASE("the report of a packing is as it was", "[packing]")
{
    const tests::PackingSample sample = tests::packing_sample();
    check_golden("packing.txt", report::to_text(sample.packed(), {}));
    check_golden("suggestion.txt", report::to_text(sample.suggested(), {false, 80}));
    const report::Packed packed = sample.packed();
    check_golden("packing.svg", report::to_svg({&packed, 1}));
}

TEST_CASE("color is there when asked for and moves nothing", "[packing]")
{
    const tests::PackingSample sample = tests::packing_sample();
    const std::string colored = report::to_text(sample.suggested(), {true, 80});
    CHECK(colored.find('\x1b') != std::string::npos);
    CHECK(without_color(colored) == report::to_text(sample.suggested(), {false, 80}));
}

TEST_CASE("every bit of every channel is in exactly one piece", "[packing]")
{
    const tests::PackingSample sample = tests::packing_sample();
    const report::Layout layout = report::layout_of(sample.packed());
    std::size_t channels = 0;
    for (const report::TargetLayout& target : layout.targets)
        for (const report::ChannelLayout& channel : target.channels) {
            ++channels;
            int next = channel.format.bits;
            for (const report::Piece& piece : channel.pieces) {
                CHECK(piece.bits > 0);
                next -= piece.bits;
                CHECK(piece.low == next);
            }
            CHECK(next == 0);
        }
    CHECK(channels == sample.module.gbuffers[0].channels.size());
    CHECK(layout.bits == 32);
}

TEST_CASE("what cannot be used says why", "[packing]")
{
    const tests::PackingSample sample = tests::packing_sample();
    const auto detail = [&](const report::Packed& packed, std::size_t target, std::size_t channel) {
        const report::Layout layout = report::layout_of(packed);
        const report::Piece& piece = layout.targets[target].channels[channel].pieces.front();
        return piece.label + ": " + piece.detail;
    };
    const report::Packed packed = sample.packed();
    CHECK(detail(packed, 0, 0) == "normal: world normal");
    CHECK(detail(packed, 2, 0) == "not there: not there under r.Lighting = baked");
    CHECK(detail(packed, 2, 1) == "irradiance: baked irradiance");
    CHECK(detail(packed, 2, 2) == "not used: not among the bits that were offered");

    // Under moving lights alone there is something else, and it may be taken.
    tests::PackingSample moving = tests::packing_sample();
    moving.module.packings[0].supported = {false, true};
    CHECK(detail(moving.packed(), 2, 0) == "not used: not among the bits that were offered");
    CHECK(detail(moving.packed(), 2, 1) ==
          "occlusion: ambient occlusion; lent: `without occlusion` takes it");
}

TEST_CASE("the picture fits 80 columns, whatever the channels are", "[packing]")
{
    tests::PackingSample sample = tests::packing_sample();
    CHECK(longest_line(report::layout_picture(sample.packed(), {})) <= 80);

    // Four channels of 16 bits need two rows; in a wide terminal they have one.
    report::Packed packed = sample.packed();
    for (std::size_t channel = 3; channel < 7; ++channel) {
        sample.module.gbuffers[0].channels[channel].formats.assign(2, {ir::Storage::unorm, 16});
        packed.room.push_back({channel, 8, 8});
    }
    const std::string narrow = report::layout_picture(packed, {});
    const std::string wide = report::layout_picture(packed, {false, 140});
    CHECK(longest_line(narrow) <= 80);
    CHECK(longest_line(wide) > 80);
    CHECK(count(narrow, "\n") > count(wide, "\n"));
    // Of numbers with two digits, those at the ends of pieces.
    CHECK_THAT(narrow, Contains("15            8 7     4 3 2   0 15"));
}

TEST_CASE("what is left is counted and named", "[packing]")
{
    tests::PackingSample sample = tests::packing_sample();
    CHECK(report::room_left(sample.packed()) == "4 of 32 free bits left: d.b[3], d.a[1..3]");
    sample.module.packings[0].fields[1].slots = {{5, 3, 5}};
    sample.module.packings[0].fields[5].slots = {{6, 0, 4}};
    CHECK(report::room_left(sample.packed()) == "none of 32 free bits left");
    sample.module.packings[0].fields.clear();
    CHECK(report::room_left(sample.packed()) == "32 of 32 free bits left: d.r, d.g, d.b, d.a");
}

TEST_CASE("names break at underscores, and inside words only where they must", "[packing]")
{
    using Lines = std::vector<std::string>;
    CHECK(report::on_lines("gain", 15, 4) == Lines{"gain"});
    CHECK(report::on_lines("diffuse_fresnel", 15, 4) == Lines{"diffuse_fresnel"});
    CHECK(report::on_lines("diffuse_fresnel_falloff", 15, 4) ==
          Lines{"diffuse_fresnel", "falloff"});
    CHECK(report::on_lines("diffuse_fresnel_falloff", 7, 4) ==
          Lines{"diffuse", "fresnel", "falloff"});
    CHECK(report::on_lines("retroreflection", 7, 4) == Lines{"retro-", "refle-", "ction"});
    CHECK(report::on_lines("tint_r bits 2-9", 9, 4) == Lines{"tint_r", "bits 2-9"});
    CHECK(report::on_lines("dual_specular_roughness_scale", 7, 4).empty());
    CHECK(report::on_lines("gain", 3, 4).empty());
}

TEST_CASE("errors are told with the input that reaches them", "[packing]")
{
    const tests::PackingSample sample = tests::packing_sample();
    CHECK(
        report::in_words(sample.packed(), sample.packed().errors.whole.witness) ==
        "gain 17.25 stored as 17, at light 53.13 and view 53.13 degrees from the normal, 180 apart "
        "around it; roughness 0.3; tint.r 0.5: radiance 1.25 becomes 1.5");

    analyze::RadianceWitness straight;
    straight.inputs = {{"l.x", 0},          {"l.y", 0},          {"l.z", 1},
                       {"v.x", 1},          {"v.y", 0},          {"v.z", 0},
                       {"base_color.r", 1}, {"base_color.g", 1}, {"base_color.b", 0.5}};
    CHECK(report::in_words(sample.packed(), straight) ==
          "at light 0 and view 90 degrees from the normal; base_color (1, 1, 0.5): radiance 0 "
          "becomes 0");
}

TEST_CASE("percentages have two or three digits", "[packing]")
{
    CHECK(report::percent(0) == "0 %");
    CHECK(report::percent(0.5) == "50 %");
    CHECK(report::percent(0.1234) == "12.3 %");
    CHECK(report::percent(0.0234) == "2.3 %");
    CHECK(report::percent(0.000234) == "0.023 %");
    CHECK(report::percent(0.00000234) == "2e-04 %");
    CHECK(report::percent(12.345) == "1234 %");
    CHECK(report::percent(21461.78) == "2.15e+06 %");
}

TEST_CASE("a default that does not come back is marked", "[packing]")
{
    const tests::PackingSample sample = tests::packing_sample();
    const report::Table table = report::field_table(sample.packed());
    REQUIRE(table.rows.size() == 6);
    CHECK(table.rows[0][5].style == report::Style::plain);
    CHECK(table.rows[1][5].text == "0.75 -> 0.7499999");
    CHECK(table.rows[1][5].style == report::Style::bad);
}

TEST_CASE("as many columns of bits as fit are shown, around the chosen ones", "[packing]")
{
    const tests::PackingSample sample = tests::packing_sample();
    const report::Table all = report::curve_table(sample.suggestion, 0);
    CHECK(all.columns.size() == 11);  // the name, 2 to 10 bits, the code
    const report::Table few = report::curve_table(sample.suggestion, 4);
    REQUIRE(few.columns.size() == 6);
    // 8, 4 and 3 bits were chosen: 4 columns from the middle, 5, two to the left of it.
    CHECK(few.columns[1].title == "3");
    CHECK(few.rows[1][2].text == "*12.5");
    CHECK(few.rows[1][3].text == "-");
}

TEST_CASE("a plot has every point, its levels and nothing outside", "[packing]")
{
    report::Plot plot;
    plot.title = "error";
    plot.series.push_back({"measured", '*', false, {{1, 1.0}, {2, 0.1}, {3, 0}}, 2});
    plot.levels.push_back({"limit", 0.3});
    const std::string text = report::plot_text(plot, {});
    CHECK(count(text, "*") == 4);  // three points and the legend
    CHECK_THAT(text, Contains("limit 30 %") && Contains("100 %") && Contains("10 %"));
    CHECK(longest_line(text) <= 80);
    const std::string svg = report::plot_svg(plot);
    CHECK(count(svg, "<circle") == 3);
    CHECK(count(svg, "\"chosen\"") == 1);

    report::Plot nothing;
    nothing.series.push_back({"measured", '*', false, {{1, 0}, {2, 0}}, 0});
    CHECK(report::plot_text(nothing, {}).empty());
    CHECK(report::plot_svg(nothing).empty());
}

TEST_CASE("JSON reads back with what the tables show", "[packing]")
{
    const tests::PackingSample sample = tests::packing_sample();
    const report::Packed both[] = {sample.packed(), sample.suggested()};
    const auto json = nlohmann::json::parse(report::to_json(both));
    CHECK(json["ok"] == true);
    REQUIRE(json["packings"].size() == 2);
    const auto& first = json["packings"][0];
    CHECK(first["model"] == "skin");
    CHECK(first["radiance_limit"] == 0.25);
    CHECK(first["layout"]["bits_left"] == 4);
    CHECK(first["layout"]["settings"]["lighting"] == "baked");
    CHECK(first["layout"]["targets"][1]["channels"][0]["pieces"][0]["label"] == "gain");
    CHECK(first["fields"][1]["place"] == "d.b[4..7]");
    CHECK(first["fields"][0]["code"] == "power(8, 127/255)");
    CHECK(first["errors"]["whole"]["worst"] == 0.125);
    CHECK(first["errors"]["parameters"]["gain"]["at"]["stored"]["gain"] == 17);
    CHECK_FALSE(first.contains("suggestion"));
    const auto& search = json["packings"][1]["suggestion"];
    CHECK(search["linear_8_bits"]["whole"]["worst"] == 2.5);
    CHECK(search["curves"]["gain"].size() == 8);
    CHECK(search["trade"][0]["shares"]["gain"] == 2);
}

TEST_CASE("the picture file and the page stand alone, in light and dark", "[packing]")
{
    const tests::PackingSample sample = tests::packing_sample();
    const report::Packed both[] = {sample.packed(), sample.suggested()};
    const std::string svg = report::to_svg(both), page = report::to_page(both);
    for (const char* outside : {"https:", "src=", "href=", "<script", "@import", "url("}) {
        CHECK_THAT(svg, !Contains(outside));
        CHECK_THAT(page, !Contains(outside));
    }
    CHECK(count(svg, "http:") == 1);  // the name of the language
    CHECK_THAT(page, !Contains("http:"));
    CHECK_THAT(svg, Contains("prefers-color-scheme: dark"));
    CHECK_THAT(page, Contains("prefers-color-scheme: dark"));
    CHECK_THAT(svg, Contains("a &lt;ray&gt; pass") && !Contains("<ray>"));
    CHECK(count(svg, "<svg") == 1);
    CHECK(count(page, "<svg") == 4);  // two layouts, two plots
    CHECK(count(svg, "<text") == count(svg, "</text>"));
    CHECK(count(svg, "<rect") - 1 == count(svg, "</rect>"));  // but the paper
    CHECK_THAT(page, Contains("packing skin on small {"));
}

TEST_CASE("a search without a result says why and what to give up", "[packing]")
{
    tests::PackingSample sample = tests::packing_sample();
    sample.suggestion.found = false;
    sample.suggestion.why_not = "40 bits are needed, 32 are there";
    report::Packed packed = sample.suggested();
    packed.met = false;
    const std::string text = report::to_text(packed, {});
    CHECK_THAT(text, Contains("40 bits are needed, 32 are there") &&
                         Contains("to fit, give up\n  `without occlusion`"));
    CHECK_THAT(text, !Contains("largest step"));
    const auto json = nlohmann::json::parse(report::to_json({&packed, 1}));
    CHECK(json["ok"] == false);
    CHECK(json["packings"][0]["suggestion"]["why_not"] == "40 bits are needed, 32 are there");
    CHECK_THAT(report::to_page({&packed, 1}),
               Contains("40 bits are needed") && Contains("No packing was found"));
}

TEST_CASE("a requirement that is not met shows", "[packing]")
{
    const tests::PackingSample sample = tests::packing_sample();
    report::Packed packed = sample.packed();
    packed.met = false;
    CHECK(report::error_table(packed).rows.back().back().style == report::Style::bad);
    CHECK(nlohmann::json::parse(report::to_json({&packed, 1}))["ok"] == false);
    CHECK_THAT(report::to_page({&packed, 1}), Contains("A requirement on radiance is not met."));
}
