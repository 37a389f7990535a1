#include "report/residual.h"

#include "report/scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace lobe::report {
namespace {

using analyze::Certificate;
using analyze::SceneFacts;
using analyze::Variant;

std::string percent_of(double share) { return fmt::format("{:.3g} %", 100 * share); }

std::string cycles_of(double cycles) { return fmt::format("{:.1f}", cycles); }

double general_price(const Specialization& of)
{
    return analyze::price_of(of.variants.general, of.family);
}

std::string of_general(const Specialization& of, double price)
{
    const double general = general_price(of);
    return general > 0 ? fmt::format("{:.2f}", price / general) : "-";
}

std::string unit_of(const Specialization& of)
{
    return of.variants.no_statistics.empty() ? std::string{analyze::name(of.family)} : "SPIR-V";
}

/// Of several, the first few.
std::string first_of(const std::vector<std::string>& names, std::size_t most)
{
    if (names.size() <= most) return fmt::format("{}", fmt::join(names, ", "));
    const std::vector<std::string> some(names.begin(),
                                        names.begin() + static_cast<std::ptrdiff_t>(most));
    return fmt::format("{} and {} more", fmt::join(some, ", "), grouped(names.size() - most));
}

std::vector<std::string> material_names(const SceneFacts& facts, const Variant& variant)
{
    std::vector<std::string> names;
    for (const std::size_t m : variant.materials) names.push_back(facts.materials[m].name);
    return names;
}

/// Effects of the module that are in a variant's code.
std::vector<std::string> effects_in(const SceneFacts& facts, const Variant& variant)
{
    std::vector<std::string> names;
    for (const analyze::EffectFact& effect : facts.effects)
        if (std::ranges::count(variant.residual.off, effect.name) == 0)
            names.push_back(effect.name);
    return names;
}

/// Why a variant has an effect: what the first of its materials that calls for it says.
std::string why_on(const SceneFacts& facts, const Variant& variant, std::size_t effect)
{
    for (const std::size_t m : variant.materials)
        if (facts.materials[m].calls[effect])
            return analyze::why_on(facts.materials[m], facts.effects[effect]) + ", " +
                   facts.materials[m].name;
    return "not decided by the scene";
}

/// Why an effect stays under an epsilon.
std::string why_kept(const analyze::Dropped& kept, double epsilon)
{
    if (!(kept.observed < epsilon)) return "changes radiance by more than " + percent_of(epsilon);
    if (!(kept.bound < epsilon)) return "no bound below " + percent_of(epsilon) + " is proved";
    return "too much with what was left out, or other materials need it";
}

std::string listed(const std::vector<double>& value)
{
    return value.size() == 1 ? fmt::format("{:.6g}", value[0])
                             : fmt::format("({:.6g})", fmt::join(value, ", "));
}

}  // namespace

bool Specialization::ok() const
{
    return std::ranges::all_of(
        certificates, [](const Certificate& each) { return each.ok() && !each.outputs.empty(); });
}

std::vector<std::string> remarks(const Specialization& of, std::size_t index)
{
    const Variant& variant = of.variants.chosen[index];
    std::vector<std::string> out{fmt::format("This shader is one scene's: {}", of.command)};
    const std::string share = of.facts.materials.size() == variant.materials.size()
                                  ? "all of the picture"
                                  : fmt::format("{} of the picture", percent_of(variant.coverage));
    out.push_back(fmt::format("For {}: {} of {} materials, {}: {}.", of.scene,
                              variant.materials.size(), of.facts.materials.size(), share,
                              first_of(material_names(of.facts, variant), 8)));
    std::vector<std::string> on, off;
    for (std::size_t i = 0; i < of.facts.effects.size(); ++i) {
        const std::string& name = of.facts.effects[i].name;
        if (std::ranges::count(variant.residual.off, name) > 0)
            off.push_back(name);
        else
            on.push_back(fmt::format("{} ({})", name, why_on(of.facts, variant, i)));
    }
    if (!on.empty()) out.push_back(fmt::format("On: {}.", fmt::join(on, "; ")));
    if (!off.empty())
        out.push_back(fmt::format("Off, and not in the code: {}.", fmt::join(off, ", ")));
    std::vector<std::string> fixed;
    for (const auto& [name, value] : variant.called.constants)
        if (!of.facts.defaults.contains(name) ||
            (std::ranges::count(variant.residual.fixed, name) > 0 &&
             std::ranges::count(variant.residual.absent, name) == 0))
            fixed.push_back(fmt::format("{} = {}", name, listed(value)));
    if (!fixed.empty()) out.push_back(fmt::format("Constants: {}.", fmt::join(fixed, ", ")));
    if (of.has_lights && !of.facts.emitters.empty())
        out.push_back(
            fmt::format("Lights, lengths in centimeters: {}.", emitters_in_words(of.facts)));
    if (index < of.certificates.size())
        for (const analyze::Dropped& dropped : of.certificates[index].dropped)
            out.push_back(fmt::format(
                "Left out for an epsilon of {}: {}, which changes radiance by at most {}.",
                percent_of(of.epsilon), dropped.effect, percent_of(dropped.bound)));
    return out;
}

Table variant_table(const Specialization& of)
{
    Table table{{{"shader"},
                 {"area", true},
                 {unit_of(of), true},
                 {"of general", true},
                 {"regs", true},
                 {"effects"},
                 {"materials"}},
                {}};
    const auto registers = [&](const analyze::Cost& cost) {
        const auto found = cost.families.find(of.family);
        return found == cost.families.end() ? "-" : std::to_string(found->second.vgprs);
    };
    for (const Variant& variant : of.variants.chosen) {
        const double price = analyze::price_of(variant.cost, of.family);
        const auto effects = effects_in(of.facts, variant);
        table.rows.push_back({{variant.name, Style::strong},
                              {percent_of(variant.coverage)},
                              {cycles_of(price)},
                              {of_general(of, price)},
                              {registers(variant.cost)},
                              {effects.empty() ? "-" : fmt::format("{}", fmt::join(effects, ", "))},
                              {first_of(material_names(of.facts, variant), 4)}});
    }
    table.rows.push_back({{"a pixel of the scene", Style::good},
                          {""},
                          {cycles_of(of.variants.cycles), Style::good},
                          {of_general(of, of.variants.cycles), Style::good}});
    table.rows.push_back({{"the general shader", Style::faint},
                          {""},
                          {cycles_of(general_price(of))},
                          {"1.00"},
                          {registers(of.variants.general)}});
    return table;
}

Table frontier_table(const Specialization& of)
{
    Table table{{{"shaders", true}, {unit_of(of) + " a pixel", true}, {"of general", true}}, {}};
    if (of.variants.frontier.size() < 2) return table;
    for (const analyze::VariantCount& count : of.variants.frontier) {
        const bool taken = count.variants == of.variants.chosen.size();
        table.rows.push_back(
            {{std::to_string(count.variants), taken ? Style::strong : Style::plain},
             {cycles_of(count.cycles)},
             {of_general(of, count.cycles)}});
    }
    return table;
}

Table certificate_table(const Specialization& of)
{
    Table table{{{"shader"},
                 {"output"},
                 {""},
                 {"same graph"},
                 {"points", true},
                 {"worst", true},
                 {"outside", true},
                 {"on the device", true},
                 {"left out"}},
                {}};
    for (std::size_t i = 0; i < of.certificates.size(); ++i) {
        const Certificate& certificate = of.certificates[i];
        for (const analyze::Equality& equal : certificate.outputs) {
            std::string dropped;
            for (const analyze::Dropped& each : certificate.dropped)
                dropped += fmt::format("{}{} (at most {})", dropped.empty() ? "" : ", ",
                                       each.effect, percent_of(each.bound));
            table.rows.push_back(
                {{of.variants.chosen[i].name, Style::strong},
                 {equal.output},
                 {equal.ok() ? "ok" : "WRONG", equal.ok() ? Style::good : Style::bad},
                 {equal.same_graph ? "yes, proved" : "no"},
                 {grouped(equal.points)},
                 {fmt::format("{:.3g}", equal.worst)},
                 {grouped(equal.outside)},
                 {equal.device.empty() ? "-" : grouped(equal.device_outside)},
                 {dropped}});
        }
    }
    return table;
}

Table kept_table(const Specialization& of)
{
    Table table{{{"shader"}, {"effect that stays"}, {"found", true}, {"proved", true}, {"why"}},
                {}};
    for (std::size_t i = 0; i < of.certificates.size(); ++i)
        for (const analyze::Dropped& kept : of.certificates[i].kept) {
            const bool is_bounded = std::isfinite(kept.bound);
            table.rows.push_back({{of.variants.chosen[i].name, Style::strong},
                                  {kept.effect},
                                  {percent_of(kept.observed)},
                                  {is_bounded ? "at most " + percent_of(kept.bound) : "-"},
                                  {why_kept(kept, of.epsilon)}});
        }
    return table;
}

std::string to_text(const Specialization& of, const Look& look)
{
    std::string out = render(effect_table(of.facts), look) + "\n";
    out += render(variant_table(of), look) + "\n";
    const Table frontier = frontier_table(of);
    if (!frontier.rows.empty()) out += render(frontier, look) + "\n";
    if (!of.certificates.empty()) out += render(certificate_table(of), look) + "\n";
    if (const Table kept = kept_table(of); !kept.rows.empty()) out += render(kept, look) + "\n";
    if (of.variants.no_statistics.empty())
        out += fmt::format("{}: issue cycles of one evaluation from vectors on {}, by {}\n",
                           analyze::name(of.family), analyze::title(of.family), of.variants.driver);
    else
        out += fmt::format("SPIR-V: instructions; no cycles: {}\n", of.variants.no_statistics);
    if (!of.variants.is_proved)
        out += "the search for the cheapest shaders gave up; there may be cheaper ones\n";
    return out;
}

}  // namespace lobe::report
