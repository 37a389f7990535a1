// Laws about integrals: distributions of normals, and what is reflected.
#include "analyze/physics/laws.h"
#include "analyze/physics/settings.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace lobe::analyze {
namespace {

constexpr std::array views{1.0, 0.5, 0.1, 0.02};

/// Half a code of an 8-bit display: what rounding may move an integral near 1 by, unseen.
constexpr double visible = 1.0 / 510;

/// Fills in what was integrated and whether the law is kept: by the definition, up to the
/// quadrature; by what was emitted, or that is off by what the contract lets a device round, and
/// nobody sees it. `breaks` judges a value with an uncertainty, `allowed` is asked when it matters.
template <class Breaks, class Allowed>
void judge(PhysicsRow& row, const HemisphereIntegral& integral, const Breaks& breaks,
           const Allowed& allowed)
{
    row.value = integral.value;
    row.exact = integral.exact;
    row.uncertainty = integral.uncertainty;
    if (breaks(integral.exact, integral.uncertainty)) return;
    const double rounding = std::abs(integral.value - integral.exact);
    row.kept = !breaks(integral.value, integral.uncertainty) ||
               (rounding <= integral.uncertainty + visible &&
                rounding <= integral.uncertainty + allowed());
    if (!row.kept) row.note = "the definition keeps it, rounding does not";
}

bool gains(double value, double uncertainty) { return !(value <= 1 + uncertainty); }

void judge_albedo(PhysicsRow& row, const HemisphereIntegral& integral, auto allowed)
{
    row.law = Law::albedo;
    judge(row, integral, gains, allowed);
    if (gains(integral.exact, integral.uncertainty))
        row.note = fmt::format("gains energy: {:.4g} of what arrives", row.exact);
}

std::string where(double view) { return fmt::format("n.v = {}", view); }

/// The integrals of settings, one per view.
using Integrals = std::vector<HemisphereIntegral>;

HemisphereJob job_of(const PhysicsSetting& setting, HemisphereJob::Over over, double view)
{
    return {setting.values, over, view, setting.alpha, setting.alpha};
}

std::string integrate_all(EmittedFunction& function, const std::vector<PhysicsSetting>& settings,
                          HemisphereJob::Over over, std::vector<Integrals>& out)
{
    std::vector<HemisphereJob> jobs;
    for (const PhysicsSetting& setting : settings)
        for (const double view : views) jobs.push_back(job_of(setting, over, view));
    Integrals all;
    if (std::string why = integrate(function, jobs, all); !why.empty()) return why;
    out.clear();
    for (std::size_t i = 0; i < settings.size(); ++i) {
        const auto first = all.begin() + static_cast<std::ptrdiff_t>(i * views.size());
        out.emplace_back(first, first + views.size());
    }
    return {};
}

bool same(const Integrals& a, const Integrals& b)
{
    return std::ranges::equal(a, b, {}, &HemisphereIntegral::exact, &HemisphereIntegral::exact);
}

class AlbedoRows {
public:
    AlbedoRows(EmittedFunction& function, bool over_light)
        : function_(function),
          over_(over_light ? HemisphereJob::Over::light : HemisphereJob::Over::nothing)
    {
    }

    std::vector<PhysicsRow> rows()
    {
        const std::vector<PhysicsSetting> surfaces = surface_settings(function_.inputs());
        std::vector<Integrals> integrals;
        std::string why = integrate_all(function_, surfaces, over_, integrals);
        for (std::size_t i = 0; why.empty() && i < surfaces.size(); ++i)
            for (std::size_t view = 0; view < views.size(); ++view)
                add(surfaces[i], integrals[i], view);
        if (why.empty()) why = add_parameters();
        if (!why.empty()) return {failed_row(function_.name(), Law::albedo, std::move(why))};
        return std::move(rows_);
    }

private:
    /// Of every end the view that reflects most; of those that do nothing alone, once for all that
    /// are alike with the others.
    std::string add_parameters()
    {
        const std::vector<ParameterEnd> ends = parameter_ends(function_.inputs());
        if (ends.empty()) return {};
        std::vector<PhysicsSetting> alone{
            parameters_at_defaults(function_.inputs(), ends.front().alone)};
        for (const ParameterEnd& end : ends) alone.push_back(end.alone);
        std::vector<Integrals> integrals;
        if (std::string why = integrate_all(function_, alone, over_, integrals); !why.empty())
            return why;
        std::vector<PhysicsSetting> together;
        for (std::size_t i = 0; i < ends.size(); ++i)
            if (same(integrals[i + 1], integrals[0]))
                together.push_back(ends[i].with_others);
            else
                add_greatest(alone[i + 1], integrals[i + 1]);
        std::vector<Integrals> with_others;
        if (std::string why = integrate_all(function_, together, over_, with_others); !why.empty())
            return why;
        for (std::size_t i = 0; i < together.size(); ++i) {
            const auto alike = [&](const Integrals& other) { return same(other, with_others[i]); };
            const auto end = with_others.begin() + static_cast<std::ptrdiff_t>(i);
            if (std::none_of(with_others.begin(), end, alike))
                add_greatest(together[i], with_others[i]);
        }
        return {};
    }

    void add_greatest(const PhysicsSetting& setting, const Integrals& integrals)
    {
        const auto most = std::ranges::max_element(integrals, {}, &HemisphereIntegral::exact);
        add(setting, integrals, static_cast<std::size_t>(most - integrals.begin()));
    }

    void add(const PhysicsSetting& setting, const Integrals& integrals, std::size_t view)
    {
        PhysicsRow& row = rows_.emplace_back();
        row.subject = physics_subject(function_.name(), setting.text);
        row.where = where(views[view]);
        judge_albedo(row, integrals[view],
                     [&] { return allowed_error(function_, job_of(setting, over_, views[view])); });
    }

    EmittedFunction& function_;
    HemisphereJob::Over over_;
    std::vector<PhysicsRow> rows_;
};

}  // namespace

std::vector<PhysicsRow> normalized_rows(EmittedFunction& function)
{
    const std::vector<WidthSetting> settings = width_settings(function.inputs());
    std::vector<HemisphereJob> jobs;
    for (const WidthSetting& setting : settings)
        jobs.push_back(
            {setting.values, HemisphereJob::Over::facets, 1, setting.alpha_x, setting.alpha_y});
    Integrals integrals;
    if (std::string why = integrate(function, jobs, integrals); !why.empty())
        return {failed_row(function.name(), Law::normalized, std::move(why))};

    const auto breaks = [](double value, double uncertainty) {
        return !(std::abs(value - 1) <= uncertainty);
    };
    std::vector<PhysicsRow> rows;
    for (std::size_t i = 0; i < jobs.size(); ++i) {
        const HemisphereIntegral& integral = integrals[i];
        PhysicsRow& row = rows.emplace_back();
        row.subject = physics_subject(function.name(), settings[i].text);
        row.law = Law::normalized;
        row.where = "l = v = h";
        judge(row, integral, breaks, [&] { return allowed_error(function, jobs[i]); });
        if (!breaks(integral.exact, integral.uncertainty)) continue;
        const double in_pi = integral.exact / std::numbers::pi;
        row.note = std::abs(in_pi - 1) <= integral.uncertainty
                       ? fmt::format("the term is pi D: {:.5g}", integral.exact)
                       : fmt::format("{:.5g}, which is {:.4g} pi", integral.exact, in_pi);
    }
    return rows;
}

std::vector<PhysicsRow> albedo_rows(EmittedFunction& function, bool over_light)
{
    return AlbedoRows{function, over_light}.rows();
}

std::vector<PhysicsRow> whole_albedo_rows(std::vector<EmittedFunction>& outputs,
                                          const std::string& name)
{
    constexpr std::array roughnesses{0.1, 0.5, 1.0};
    constexpr auto over = HemisphereJob::Over::light;
    std::vector<std::vector<PhysicsSetting>> settings;  // by output, roughness
    std::vector<std::vector<Integrals>> integrals;
    for (EmittedFunction& function : outputs) {
        auto& of = settings.emplace_back();
        for (const double roughness : roughnesses)
            of.push_back(dielectric_setting(function.inputs(), roughness));
        if (std::string why = integrate_all(function, of, over, integrals.emplace_back());
            !why.empty())
            return {failed_row(name, Law::albedo, std::move(why))};
    }
    std::vector<PhysicsRow> rows;
    for (std::size_t r = 0; r < roughnesses.size(); ++r)
        for (std::size_t view = 0; view < views.size(); ++view) {
            HemisphereIntegral sum;
            for (const auto& of : integrals) {
                sum.value += of[r][view].value;
                sum.exact += of[r][view].exact;
                sum.uncertainty += of[r][view].uncertainty;
            }
            PhysicsRow& row = rows.emplace_back();
            row.subject =
                fmt::format("{}, white dielectric, roughness = {:.6g}", name, roughnesses[r]);
            row.where = where(views[view]);
            judge_albedo(row, sum, [&] {
                double allowed = 0;
                for (std::size_t k = 0; k < outputs.size(); ++k)
                    allowed += allowed_error(outputs[k], job_of(settings[k][r], over, views[view]));
                return allowed;
            });
        }
    return rows;
}

}  // namespace lobe::analyze
