// A page of what a scene was specialized to.
#include "report/residual.h"
#include "report/scene.h"

#include <fmt/format.h>

namespace lobe::report {
namespace {

Paragraph verdict_of(const Specialization& of)
{
    const std::size_t shaders = of.variants.chosen.size();
    const double general = analyze::price_of(of.variants.general, of.family);
    const std::string cost =
        general > 0 ? fmt::format(", at {:.0f} % of the cost of one shader for everything",
                                  100 * of.variants.cycles / general)
                    : "";
    const std::string made = fmt::format(
        "{} material{} in {} shader{}{}.", of.facts.materials.size(),
        of.facts.materials.size() == 1 ? "" : "s", shaders, shaders == 1 ? "" : "s", cost);
    if (of.certificates.empty()) return {made + " Nothing was certified.", Style::plain};
    return of.ok() ? Paragraph{made + " The certificate holds.", Style::good}
                   : Paragraph{made + " The certificate does not hold.", Style::bad};
}

Section section(const std::string& title, const std::string& text, Table table)
{
    Section out;
    out.title = title;
    if (!text.empty()) out.paragraphs.push_back({text});
    out.tables.push_back(std::move(table));
    return out;
}

}  // namespace

Document to_document(const Specialization& of)
{
    Document page;
    page.title = fmt::format("{} under {}", of.scene, of.facts.model);
    page.verdict = verdict_of(of);
    page.sections.push_back(section("Effects", "", effect_table(of.facts)));
    const std::string unit =
        of.variants.no_statistics.empty()
            ? fmt::format("Issue cycles of one evaluation from vectors on {}, by {}.",
                          analyze::title(of.family), of.variants.driver)
            : fmt::format("SPIR-V instructions; no cycles: {}.", of.variants.no_statistics);
    page.sections.push_back(section("Shaders", unit, variant_table(of)));
    if (Table frontier = frontier_table(of); !frontier.rows.empty())
        page.sections.push_back(section("More shaders, fewer cycles",
                                        "The cheapest choice of each number of shaders.",
                                        std::move(frontier)));
    if (!of.certificates.empty())
        page.sections.push_back(section("Certificate",
                                        "Worst: the largest difference between the exact values of "
                                        "both shaders, in half widths "
                                        "of what a device may return for the general one.",
                                        certificate_table(of)));
    if (Table kept = kept_table(of); !kept.rows.empty())
        page.sections.push_back(section("What an epsilon does not let go", "", std::move(kept)));
    page.sections.push_back(section("Materials", "", material_table(of.facts)));
    Section inputs = section("Inputs", "", input_table(of.facts));
    inputs.text = surroundings(of.facts);
    page.sections.push_back(std::move(inputs));
    return page;
}

}  // namespace lobe::report
