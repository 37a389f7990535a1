#include "analyze/hemisphere.h"

#include "analyze/quadrature.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace lobe::analyze {
namespace {

constexpr double pi = std::numbers::pi;
constexpr int fine_order = 8;
constexpr int coarse_order = fine_order / 2;
constexpr std::size_t batch_size = std::size_t{1} << 17;

std::vector<DirectionNode> nodes_of(const EntryInputs& inputs, const HemisphereJob& job, int order)
{
    using Over = HemisphereJob::Over;
    switch (job.over) {
    case Over::light:
        return light_nodes(job.cos_view, std::min(job.alpha_x, job.alpha_y), !inputs.has_tangents(),
                           order);
    case Over::facets: return facet_nodes(job.alpha_x, job.alpha_y, order);
    case Over::nothing: break;
    }
    return {{{0, 0, 1}, 1}};
}

void add_points(const EntryInputs& inputs, const HemisphereJob& job,
                std::span<const DirectionNode> nodes, EmittedFunction::Batch& batch)
{
    const Vector v{std::sqrt(1 - job.cos_view * job.cos_view), 0, job.cos_view};
    const bool facets = job.over == HemisphereJob::Over::facets;
    EntryInputs::Values values = job.values;
    for (const DirectionNode& node : nodes) {
        inputs.place(values, {{}, node.direction, facets ? node.direction : v});
        batch.add(values);
    }
}

/// The weighted sum of one component's results from `first` on.
double sum(std::span<const DirectionNode> nodes, const std::vector<double>& results,
           std::size_t first)
{
    double total = 0;
    for (std::size_t i = 0; i < nodes.size(); ++i) total += nodes[i].weight * results[first + i];
    return total;
}

std::vector<double> sums(std::span<const DirectionNode> nodes, const ResultColumns& results,
                         std::size_t first)
{
    std::vector<double> out;
    for (const auto& component : results) out.push_back(sum(nodes, component, first));
    return out;
}

/// Jobs whose points are evaluated together.
class BatchOfJobs {
public:
    BatchOfJobs(EmittedFunction& function, std::vector<HemisphereIntegral>& out)
        : function_(function), out_(out)
    {
    }

    void add(const HemisphereJob& job)
    {
        const EntryInputs& inputs = function_.inputs();
        fine_.push_back(nodes_of(inputs, job, fine_order));
        coarse_.push_back(nodes_of(inputs, job, coarse_order));
        add_points(inputs, job, fine_.back(), points_);
        add_points(inputs, job, coarse_.back(), coarse_points_);
    }

    bool full() const { return points_.size() >= batch_size; }

    std::string finish()
    {
        ResultColumns emitted;
        if (std::string why = function_.emitted(points_, emitted); !why.empty()) return why;
        const ResultColumns exact = function_.exact(points_);
        const ResultColumns at_floats = function_.exact_at_floats(points_);
        const ResultColumns coarse = function_.exact(coarse_points_);
        std::size_t first = 0, coarse_first = 0;
        for (std::size_t job = 0; job < fine_.size(); ++job) {
            const std::vector<double> exacts = sums(fine_[job], exact, first);
            const auto k =
                static_cast<std::size_t>(std::ranges::max_element(exacts) - exacts.begin());
            HemisphereIntegral& integral = out_.emplace_back();
            integral.exact = exacts[k];
            integral.value = sum(fine_[job], emitted[k], first);
            const double halved = sum(coarse_[job], coarse[k], coarse_first);
            const double rounded = sum(fine_[job], at_floats[k], first);
            // The sums are of as many doubles as there are nodes.
            const double summed = static_cast<double>(fine_[job].size()) * 0x1p-53 * exacts[k];
            integral.uncertainty = std::abs(integral.exact - halved) +
                                   std::abs(rounded - integral.exact) + std::abs(summed);
            first += fine_[job].size();
            coarse_first += coarse_[job].size();
        }
        return {};
    }

private:
    EmittedFunction& function_;
    std::vector<HemisphereIntegral>& out_;
    std::vector<std::vector<DirectionNode>> fine_, coarse_;
    EmittedFunction::Batch points_{function_.inputs().columns()};
    EmittedFunction::Batch coarse_points_{function_.inputs().columns()};
};

}  // namespace

std::vector<DirectionNode> light_nodes(double cos_view, double alpha, bool symmetric, int order)
{
    const double view = std::acos(cos_view);
    const double finest = std::max(alpha / 4, 0x1p-16);
    // v.l = 0 meets the horizon at a right angle to v; its circle ends at pi/2 - view.
    const std::array polar{NarrowPlace{view, finest}, NarrowPlace{pi / 2, finest},
                           NarrowPlace{pi / 2 - view, 0x1p-6}};
    std::vector<DirectionNode> out;
    for (const QuadratureNode& theta : gauss_legendre(graded_cells(0, pi / 2, polar), order)) {
        const double sine = std::sin(theta.at), cosine = std::cos(theta.at);
        // A half vector tilted sideways by some angle turns the light by twice that times v.h.
        const double near =
            std::max(finest, std::abs(theta.at - view) / 2) * std::max(cos_view, finest);
        std::vector<NarrowPlace> around{{pi, near / std::max(sine, near / pi)}};
        const double across = -cosine * cos_view / (sine * std::sin(view));
        if (std::abs(across) < 1) around.push_back({std::acos(across), 0x1p-6});
        for (const QuadratureNode& phi : gauss_legendre(graded_cells(0, pi, around), order)) {
            const double weight = theta.weight * sine * phi.weight;
            const double x = sine * std::cos(phi.at), y = sine * std::sin(phi.at);
            // Without a tangent frame both sides of the plane of view are alike.
            out.push_back({{x, y, cosine}, symmetric ? 2 * weight : weight});
            if (!symmetric) out.push_back({{x, -y, cosine}, weight});
        }
    }
    return out;
}

std::vector<DirectionNode> facet_nodes(double alpha_x, double alpha_y, int order)
{
    const std::array ends{NarrowPlace{0, 0x1p-4}, NarrowPlace{1, 0x1p-10}};
    const int azimuths = 4 * order;
    std::vector<DirectionNode> out;
    for (const QuadratureNode& u : gauss_legendre(graded_cells(0, 1, ends), order)) {
        const double r = std::sqrt(u.at / (1 - u.at));
        for (int i = 0; i < azimuths; ++i) {
            const double phi = 2 * pi * (i + 0.5) / azimuths;
            const double x = alpha_x * r * std::cos(phi), y = alpha_y * r * std::sin(phi);
            const double cosine = 1 / std::sqrt(1 + x * x + y * y);
            // cos dw = cos^4 dslope, and dslope = alpha_x alpha_y r dr dphi.
            const double weight = u.weight * (2 * pi / azimuths) * alpha_x * alpha_y *
                                  std::pow(cosine, 4) / (2 * (1 - u.at) * (1 - u.at));
            out.push_back({{x * cosine, y * cosine, cosine}, weight});
        }
    }
    return out;
}

std::string integrate(EmittedFunction& function, std::span<const HemisphereJob> jobs,
                      std::vector<HemisphereIntegral>& out)
{
    out.clear();
    for (std::size_t next = 0; next < jobs.size();) {
        BatchOfJobs batch{function, out};
        while (next < jobs.size() && !batch.full()) batch.add(jobs[next++]);
        if (std::string why = batch.finish(); !why.empty()) return why;
    }
    return {};
}

double allowed_error(const EmittedFunction& function, const HemisphereJob& job)
{
    const std::vector<DirectionNode> nodes = nodes_of(function.inputs(), job, fine_order);
    EmittedFunction::Batch batch{function.inputs().columns()};
    add_points(function.inputs(), job, nodes, batch);
    return std::ranges::max(sums(nodes, function.allowed(batch), 0));
}

}  // namespace lobe::analyze
