// Random trees and random lists: what holds for all of them.
#include "engine/lines.h"
#include "engine/tree.h"

#include <catch2/catch.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <random>
#include <vector>

namespace lobe::engine {
namespace {

class Dice {
public:
    explicit Dice(unsigned seed) : engine_(seed) {}
    int below(int count) { return static_cast<int>(engine_() % static_cast<unsigned>(count)); }
    bool one_in(int count) { return below(count) == 0; }
    template <class T>
    const T& pick(const std::vector<T>& list)
    {
        return list[static_cast<std::size_t>(below(static_cast<int>(list.size())))];
    }

private:
    std::mt19937 engine_;
};

enum class Ends {
    lf,
    crlf,
    mixed
};

/// A few files in which line `edit_k(x);` is where edit k goes.
struct Sample {
    Files files;
    std::string list;
};

std::string edit_text(Dice& dice, int edit)
{
    static const std::vector<std::string> actions = {"before", "after", "replace", "append",
                                                     "clone"};
    const std::string action = dice.pick(actions);
    std::string text = fmt::format("edit e{} \"words\"\n", edit);
    if (dice.one_in(4)) text += "flush\n";
    if (dice.one_in(6)) text += "when sometimes\n";
    const bool wide = dice.one_in(4);
    text += fmt::format("at edit_{}\\((x)\\){}\n{}\n", edit, wide ? "[^;]*;" : "", action);
    const bool in_line = action == "append" || action == "clone";
    text += "| new_${Model}_${extra}\n";
    if (!in_line && dice.one_in(2)) text += "|\n|   more ${1}\n";
    if (!in_line && dice.one_in(3)) text += "| //% for pin in pins\n| ${pin.name}\n| //% end\n";
    return text;
}

Sample random_sample(Dice& dice, Ends ends)
{
    static const std::vector<std::string> words = {
        "alpha",         "\tbeta = 1;", "",      "  ",       "// remark /* edit_0(x)",
        "\t\t{ gamma }", "'",           "\"s\"", "\xff\xfe", "#if A",
        "#endif",        "x \r y",      "//-",   "}"};
    Sample sample;
    sample.list = "word sometimes \"words\"\n";
    int edits = 0;
    for (int file = 0, count = 1 + dice.below(3); file < count; ++file) {
        std::vector<std::string> lines;
        sample.list += fmt::format("file F{}\n", file);
        for (int line = 0, size = 1 + dice.below(12); line < size; ++line) {
            if (!dice.one_in(3)) {
                lines.push_back(dice.pick(words));
                continue;
            }
            lines.push_back(fmt::format("{}edit_{}(x);", dice.one_in(2) ? "\t " : "", edits));
            // The anchor may reach over the line's end.
            if (dice.one_in(3)) lines.back().insert(lines.back().size() - 1, "\n    + 1");
            sample.list += edit_text(dice, edits++);
        }
        Lines text;
        text.byte_order_mark = dice.one_in(5);
        for (std::string& several : lines) {
            several += '\n';
            for (const std::string_view line : split_lines(several)) {
                const bool crlf = ends == Ends::crlf || (ends == Ends::mixed && dice.one_in(2));
                text.lines.push_back({std::string{line}, crlf ? LineEnd::crlf : LineEnd::lf});
            }
        }
        if (dice.one_in(3) && !text.lines.back().text.empty())
            text.lines.back().end = LineEnd::none;
        sample.files[fmt::format("F{}", file)] = to_bytes(text);
    }
    if (dice.one_in(2)) sample.list += "new New/${Model}.ush functions.ush\n";
    return sample;
}

/// A line goes, comes twice or changes its place, or a byte becomes another.
void damage(Dice& dice, std::string& bytes)
{
    if (bytes.empty() || dice.one_in(2)) return;
    Lines text = to_lines(bytes);
    const auto any = [&] {
        return static_cast<std::size_t>(dice.below(static_cast<int>(text.lines.size())));
    };
    const std::size_t at = any();
    const Line line = text.lines[at];
    switch (dice.below(4)) {
    case 0: text.lines.erase(text.lines.begin() + static_cast<std::ptrdiff_t>(at)); break;
    case 1: text.lines.insert(text.lines.begin() + static_cast<std::ptrdiff_t>(any()), line); break;
    case 2: std::swap(text.lines[at], text.lines[any()]); break;
    default:
        if (!line.text.empty())
            text.lines[at]
                .text[static_cast<std::size_t>(dice.below(static_cast<int>(line.text.size())))] =
                "/ x1\n"[dice.below(5)];
    }
    bytes = to_bytes(text);
}

Request random_request(Dice& dice, const std::string& model)
{
    Request request = request_of(model);
    request.words.clear();
    if (dice.one_in(2)) request.words.push_back("sometimes");
    request.values.texts["extra"] = fmt::format("{}", dice.below(3));
    request.values.lists["pins"].resize(static_cast<std::size_t>(dice.below(3)));
    request.files[0].second += dice.one_in(2) ? "// more\n" : "";
    return request;
}

Plan patch(const Files& files, const EditList& list, const Request& request)
{
    Plan plan = plan_patch(tree_of(files), list, request);
    CHECK(shown(plan.obstacles) == "");
    return plan;
}

Files patched(const Files& files, const EditList& list, const Request& request)
{
    return applied(files, patch(files, list, request));
}

Files reverted(const Files& files, const EditList& list, const std::string& model)
{
    Request request;
    request.model = model;
    const Plan plan = plan_revert(tree_of(files), list, request);
    CHECK(shown(plan.obstacles) == "");
    return applied(files, plan);
}

/// A file of one line without an end does not say what lines end in.
bool shows_its_ends(const Files& files)
{
    return std::ranges::all_of(
        files, [](const auto& file) { return file.second.find('\n') != std::string::npos; });
}

constexpr int samples = 300;

}  // namespace

TEST_CASE("what is applied and reverted is as it was, byte by byte", "[engine][property]")
{
    for (unsigned seed = 0; seed < samples; ++seed) {
        Dice dice{seed};
        const Sample sample = random_sample(dice, static_cast<Ends>(seed % 3));
        const EditList list = list_of(sample.list);
        const Request request = random_request(dice, "Gloss");
        const Files with = patched(sample.files, list, request);
        INFO("seed " << seed << "\n" << sample.list);
        REQUIRE(reverted(with, list, "Gloss") == sample.files);
    }
}

TEST_CASE("what is applied twice is applied once", "[engine][property]")
{
    for (unsigned seed = 0; seed < samples; ++seed) {
        Dice dice{seed};
        const Sample sample = random_sample(dice, static_cast<Ends>(seed % 3));
        const EditList list = list_of(sample.list);
        const Request request = random_request(dice, "Gloss");
        INFO("seed " << seed << "\n" << sample.list);
        const Files with = patched(sample.files, list, request);
        REQUIRE(patch(with, list, request).changes.empty());
    }
}

TEST_CASE("a patch over a patch is the patch of the engine's own tree", "[engine][property]")
{
    for (unsigned seed = 0; seed < samples; ++seed) {
        Dice dice{seed};
        const Sample sample = random_sample(dice, static_cast<Ends>(seed % 2));
        const EditList list = list_of(sample.list);
        const Request first = random_request(dice, "Gloss");
        const Request second = random_request(dice, "Gloss");
        INFO("seed " << seed << "\n" << sample.list);
        REQUIRE(patched(patched(sample.files, list, first), list, second) ==
                patched(sample.files, list, second));
    }
}

TEST_CASE("line ends and patches commute", "[engine][property]")
{
    for (unsigned seed = 0; seed < samples; ++seed) {
        Dice dice{seed};
        const Sample sample = random_sample(dice, Ends::lf);
        if (!shows_its_ends(sample.files)) continue;
        const EditList list = list_of(sample.list);
        const Request request = random_request(dice, "Gloss");
        INFO("seed " << seed << "\n" << sample.list);
        REQUIRE(patched(with_crlf(sample.files), list, request) ==
                with_crlf(patched(sample.files, list, request)));
    }
}

TEST_CASE("a damaged tree is refused or understood, never made worse", "[engine][property]")
{
    int refused = 0;
    int understood = 0;
    for (unsigned seed = 0; seed < 3 * samples; ++seed) {
        Dice dice{seed};
        const Sample sample = random_sample(dice, static_cast<Ends>(seed % 3));
        const EditList list = list_of(sample.list);
        const Request request = random_request(dice, "Gloss");
        Files files = patched(sample.files, list, request);
        if (dice.one_in(2)) {
            const Plan plan = plan_patch(tree_of(files), list, random_request(dice, "Velvet"));
            files = applied(files, plan);
        }
        for (auto& [path, bytes] : files) damage(dice, bytes);
        INFO("seed " << seed << "\n" << sample.list);

        const Plan plan = plan_patch(tree_of(files), list, request);
        if (plan.obstacles.empty()) {
            ++understood;
            REQUIRE(patch(applied(files, plan), list, request).changes.empty());
        } else {
            ++refused;
            REQUIRE(plan.changes.empty());
        }
        Request only_name;
        only_name.model = "Gloss";
        const Plan back = plan_revert(tree_of(files), list, only_name);
        if (!back.obstacles.empty()) continue;
        for (const auto& [path, bytes] : applied(files, back))
            REQUIRE(bytes.find("// BEGIN lobe Gloss ") == std::string::npos);
    }
    // Both happen, or the damage is not what it should be.
    CHECK(refused > samples / 3);
    CHECK(understood > samples / 3);
}

TEST_CASE("the second model comes out before the first", "[engine][property]")
{
    int nested = 0;
    for (unsigned seed = 0; seed < samples; ++seed) {
        Dice dice{seed};
        const Sample sample = random_sample(dice, static_cast<Ends>(seed % 3));
        const EditList list = list_of(sample.list);
        const Request first = random_request(dice, "Gloss");
        const Request second = random_request(dice, "Velvet");
        INFO("seed " << seed << "\n" << sample.list);
        const Files one = patched(sample.files, list, first);
        const Plan plan = plan_patch(tree_of(one), list, second);
        // The second one's anchors see what the first one wrote: copies of a line hit twice.
        if (!plan.obstacles.empty()) continue;
        const Files two = applied(one, plan);
        REQUIRE(patch(two, list, first).changes.empty());
        REQUIRE(patch(two, list, second).changes.empty());
        REQUIRE(reverted(two, list, "Velvet") == one);
        REQUIRE(reverted(reverted(two, list, "Velvet"), list, "Gloss") == sample.files);

        Request only_name;
        only_name.model = "Gloss";
        const Plan wrong_order = plan_revert(tree_of(two), list, only_name);
        if (wrong_order.obstacles.empty()) {
            REQUIRE(reverted(applied(two, wrong_order), list, "Velvet") == sample.files);
        } else {
            ++nested;
            REQUIRE(wrong_order.changes.empty());
        }
    }
    CHECK(nested > samples / 10);
}

}  // namespace lobe::engine
