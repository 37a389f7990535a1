// `lobec table`: a term of one or two numbers as a texture, the table of the split sum, and the
// constants of its analytic fit.
#include "analyze/table.h"

#include "analyze/environment/analytic_fit.h"
#include "analyze/environment/baked_table.h"
#include "analyze/environment/texture_file.h"
#include "cli/commands.h"
#include "cli/outputs.h"
#include "cli/program.h"
#include "cli/settings.h"
#include "report/baked_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <memory>
#include <utility>

namespace lobe::cli {
namespace {

constexpr std::size_t longest_side = 4096;
constexpr std::size_t most_texels = std::size_t{1} << 22;

/// The whole text as a number.
template <class Number>
std::optional<Number> number_of(std::string_view text)
{
    Number value{};
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
    return value;
}

struct Tabulate {
    std::string input;
    std::string term;
    std::string size;
    std::string format = "unorm16";
    std::string places = "ends";
    std::string across;
    std::vector<std::string> ranges;
    std::vector<std::string> settings;
    std::string output;
    std::string kind;
    std::string json;
    std::uint32_t samples = 0;
    std::size_t points = 16384;
    unsigned jobs = 0;
    bool split_sum = false;
    bool fit = false;

    int run(const Terminal& terminal) const
    {
        const std::vector<Output> outputs{{"--output", output}, {"--json", json}};
        if (const std::string why = conflict(outputs); !why.empty()) return fail(terminal, why);
        if (samples > 0 && !split_sum) return fail(terminal, "--samples goes with --split-sum");
        if (fit && !split_sum) return fail(terminal, "--fit goes with --split-sum");
        if (fit && !output.empty()) return fail(terminal, "--fit makes no table for --output");

        Program program = read_and_check(terminal, {input});
        print(terminal, program.diagnostics, program.sources);
        if (program.status != success) return program.status;
        if (program.modules.size() != 1)
            return fail(terminal, "table takes one file, not a folder");
        if (const std::string why = specialize(program, settings); !why.empty())
            return fail(terminal, why);
        const ir::Module& module = program.modules.front();
        const auto function = analyze::find_function(module, term);
        if (!function) return unknown_term(terminal, input, module, term);

        std::string why;
        std::optional<analyze::BakeSubject> subject;
        if (split_sum) {
            auto visibility = analyze::Visibility::of(module, *function, why);
            if (!visibility) return fail(terminal, why);
            if (fit) return fits(terminal, *visibility);
            subject = analyze::split_sum_to_bake(fmt::format("split sum of {}", term),
                                                 std::move(*visibility), samples, jobs);
        } else {
            subject = analyze::term_to_bake(module, *function, jobs, why);
            if (!subject) return fail(terminal, why);
        }
        return bake(terminal, *subject);
    }

    int bake(const Terminal& terminal, analyze::BakeSubject& subject) const
    {
        const auto texels =
            analyze::find_texel_format(format, static_cast<int>(subject.components.size()));
        if (!texels)
            return fail(terminal, fmt::format("unknown format `{}`; there are {}", format,
                                              analyze::texel_format_names()));
        if (const std::string why = arrange(subject); !why.empty()) return fail(terminal, why);
        const auto file = file_kind();
        if (!output.empty() && !file)
            return fail(terminal,
                        fmt::format("`{}` says no kind of file; name one with --as: {}", output,
                                    fmt::join(analyze::texture_file_names, ", ")));

        std::string why;
        std::optional<analyze::BakedTable> table;
        {
            Progress progress{terminal};
            progress.show(fmt::format("{}: {}", subject.name, subject.how));
            table = analyze::bake(subject, *texels, points, why);
        }
        if (!table) return fail(terminal, why + at_fault(why));
        if (!output.empty()) {
            why = analyze::unsuited(*table, *file);
            if (!why.empty()) return fail(terminal, why);
        }
        const std::vector<Output> outputs{
            {"--output", output, output.empty() ? "" : analyze::to_file(*table, *file)},
            {"--json", json, report::to_json(*table)}};
        if (!is_piped(outputs) && !terminal.quiet)
            fmt::print("{}", report::to_text(*table, look(terminal)));
        return write(terminal, outputs, success);
    }

    int fits(const Terminal& terminal, const analyze::Visibility& visibility) const
    {
        constexpr std::size_t lattice = 65;
        std::vector<report::NamedFit> found;
        {
            Progress progress{terminal};
            progress.show("integrating, then fitting");
            const analyze::SplitSumSurface surface{visibility, lattice, lattice, jobs};
            const auto add = [&](std::string name, const analyze::AnalyticFit& constants) {
                found.push_back({std::move(name), constants, surface.error_of(constants)});
            };
            add("published", analyze::published_fit);
            add("least mean square", analyze::fitted(surface, analyze::FitGoal::mean));
            add("least worst error", analyze::fitted(surface, analyze::FitGoal::worst));
        }
        const std::vector<Output> outputs{{"--json", json, report::to_json(term, found)}};
        if (!is_piped(outputs) && !terminal.quiet)
            fmt::print("{}", report::to_text(term, found, look(terminal)));
        return write(terminal, outputs, success);
    }

    static report::Look look(const Terminal& terminal)
    {
        return {terminal.color_on_stdout(), terminal.width()};
    }

    /// A way out of what a format cannot hold.
    static std::string at_fault(const std::string& why)
    {
        return why.find("UNORM holds 0 to 1") == std::string::npos
                   ? ""
                   : "\n  = help: --format half or --format float holds more";
    }

    std::optional<analyze::TextureFile> file_kind() const
    {
        if (!kind.empty()) return analyze::find_texture_file(kind);
        if (output == "-") return analyze::TextureFile::csv;
        const std::size_t dot = output.rfind('.');
        return dot == std::string::npos ? std::nullopt
                                        : analyze::find_texture_file(output.substr(dot + 1));
    }

    /// Sizes, places and ranges of the axes, as the options say. Why not, or empty.
    std::string arrange(analyze::BakeSubject& subject) const
    {
        std::vector<analyze::TableAxis>& axes = subject.axes;
        const auto find = [&](std::string_view name) {
            return std::ranges::find(axes, name, &analyze::TableAxis::name);
        };
        std::string names;
        for (const analyze::TableAxis& axis : axes)
            names += (names.empty() ? "" : " and ") + axis.name;
        const auto unknown = [&](std::string_view name) {
            return fmt::format("`{}` depends on {}, not on `{}`", subject.name, names, name);
        };

        for (const std::string& range : ranges) {
            const std::size_t equals = range.find('=');
            const std::size_t dots = range.find("..");
            const auto axis = find(range.substr(0, equals));
            if (equals == std::string::npos || dots == std::string::npos || dots < equals)
                return fmt::format("`{}` is no range; write NAME=LOW..HIGH", range);
            if (axis == axes.end()) return unknown(range.substr(0, equals));
            const auto low = number_of<double>(range.substr(equals + 1, dots - equals - 1));
            const auto high = number_of<double>(range.substr(dots + 2));
            if (!low || !high || !(*low < *high) || !std::isfinite(*high - *low))
                return fmt::format("`{}` is no range; write NAME=LOW..HIGH", range);
            if (*high < axis->least || *low > axis->greatest)
                return fmt::format("`{}` lies outside of what `{}` can be, [{}, {}]", range,
                                   axis->name, axis->least, axis->greatest);
            axis->low = *low;
            axis->high = *high;
        }
        if (!across.empty()) {
            const auto first = find(across);
            if (first == axes.end()) return unknown(across);
            if (first != axes.begin()) turn(subject);
        }
        for (analyze::TableAxis& axis : axes)
            axis.places =
                places == "ends" ? analyze::TexelPlaces::ends : analyze::TexelPlaces::centers;
        return resize(subject);
    }

    /// The second axis across, the first one down.
    static void turn(analyze::BakeSubject& subject)
    {
        std::swap(subject.axes[0], subject.axes[1]);
        const auto turned = [](analyze::PlaceFunction values) -> analyze::PlaceFunction {
            return [values = std::move(values)](std::span<const analyze::Place> asked) {
                std::vector<analyze::Place> back;
                for (const analyze::Place& at : asked) back.push_back({at.y, at.x});
                return values(back);
            };
        };
        subject.texels = turned(std::move(subject.texels));
        subject.exact = turned(std::move(subject.exact));
    }

    std::string resize(analyze::BakeSubject& subject) const
    {
        std::vector<analyze::TableAxis>& axes = subject.axes;
        const std::string wanted = !size.empty() ? size : axes.size() == 2 ? "32x32" : "256";
        const std::size_t by = wanted.find('x');
        const auto width = number_of<std::size_t>(std::string_view{wanted}.substr(0, by));
        const auto height = by == std::string::npos
                                ? std::optional<std::size_t>{1}
                                : number_of<std::size_t>(std::string_view{wanted}.substr(by + 1));
        if (!width || !height)
            return fmt::format("`{}` is no size; write WIDTHxHEIGHT, such as 32x32", wanted);
        if (axes.size() == 2 && by == std::string::npos)
            return fmt::format("`{}` depends on {} and {}: write WIDTHxHEIGHT", subject.name,
                               axes[0].name, axes[1].name);
        if (axes.size() == 1 && *height != 1)
            return fmt::format("`{}` depends on {} alone: write WIDTH", subject.name, axes[0].name);
        for (const std::size_t side : {*width, axes.size() == 2 ? *height : *width})
            if (side < 2 || side > longest_side)
                return fmt::format("a table has 2 to {} texels along a side, not {}", longest_side,
                                   side);
        if (*width * *height > most_texels)
            return fmt::format("a table has at most {} texels, not {}", most_texels,
                               *width * *height);
        axes[0].size = *width;
        if (axes.size() == 2) axes[1].size = *height;
        return {};
    }
};

}  // namespace

void add_table(CLI::App& app, const Terminal& terminal, int& status)
{
    auto* command = app.add_subcommand(
        "table", "Tabulate a term of one or two numbers, or the split sum, with its errors");
    auto table = std::make_shared<Tabulate>();
    command->add_option("FILE", table->input, "A .lobe file")->required();
    command
        ->add_option("TERM", table->term,
                     "A term or form; with --split-sum a visibility: V_SmithGGX")
        ->required();
    command->add_flag("--split-sum", table->split_sum,
                      "Scale and bias of F0 with this visibility, over n.v and roughness");
    command
        ->add_option("--samples", table->samples,
                     "The split sum by this many importance samples, not by quadrature")
        ->check(CLI::Range(1, 1 << 20));
    command->add_flag("--fit", table->fit, "No table: the analytic fit's constants instead");
    command->add_option("--size", table->size,
                        "WIDTHxHEIGHT in texels, or WIDTH (default: 32x32, or 256)");
    command
        ->add_option("--format", table->format,
                     "Of texels: " + analyze::texel_format_names() +
                         "; the last four by the number of components")
        ->capture_default_str();
    command
        ->add_option("--texels", table->places,
                     "ends: the first and last on the ends of the range; centers: in the middle of "
                     "equal parts")
        ->check(CLI::IsMember({"ends", "centers"}))
        ->capture_default_str();
    command->add_option("--across", table->across, "The argument that changes along a row");
    command
        ->add_option("--range", table->ranges,
                     "NAME=LOW..HIGH: what an axis spans; can be repeated")
        ->allow_extra_args(false);
    command
        ->add_option("--set", table->settings,
                     "Fix a parameter: name=value, or name=r,g,b; can be repeated")
        ->allow_extra_args(false);
    command->add_option("-o,--output", table->output,
                        "Where to write the table; `-` is standard output");
    command
        ->add_option("--as", table->kind,
                     "Kind of file (default: as the name ends, csv for `-`): dds, png, csv, h")
        ->check(CLI::IsMember({"dds", "png", "csv", "h"}));
    command->add_option("--json", table->json, "Write errors as JSON; `-` is standard output");
    command->add_option("--points", table->points, "About how many places errors are measured at")
        ->check(CLI::Range(64, 1 << 22))
        ->capture_default_str();
    command->add_option("-j,--jobs", table->jobs, "Threads (default: one per core)");
    command->footer(
        "Three errors, apart: what the format loses, what linear interpolation between texels\n"
        "loses, and both with a texture unit's weights of 8 bits. docs/environment.md says more.\n"
        "Examples: lobec table models/microfacet.lobe V_SmithGGX --split-sum --format r16g16 -o "
        "lut.dds\n"
        "          lobec table models/microfacet.lobe V_SmithGGX --split-sum --fit\n"
        "          lobec table models/ue4.lobe EnvBRDFApprox_scale --size 64x64 --format r8 -o "
        "scale.png");
    command->callback([table, &terminal, &status] { status = table->run(terminal); });
}

}  // namespace lobe::cli
