#include "analyze/physics/hemisphere.h"

#include "analyze/physics/quadrature.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace lobe::analyze {
namespace {

constexpr double pi = std::numbers::pi;
constexpr int fine_order = 8;
constexpr int coarse_order = fine_order / 2;
/// What more nodes are spent for, and how many: no promise, as the integral says how sure it is.
constexpr double wanted = 0x1p-16;
constexpr std::size_t most_nodes = std::size_t{1} << 16;
constexpr std::size_t batch_size = std::size_t{1} << 17;

std::vector<DirectionNode> nodes_of(const EntryInputs& inputs, const HemisphereJob& job,
                                    Fineness fineness)
{
    using Over = HemisphereJob::Over;
    switch (job.over) {
    case Over::light:
        return light_nodes(job.cos_view, std::min(job.alpha_x, job.alpha_y), !inputs.has_tangents(),
                           fineness);
    case Over::facets: return facet_nodes(job.alpha_x, job.alpha_y, fineness);
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

/// A job's nodes, and its integral by the definition.
struct Prepared {
    std::vector<DirectionNode> nodes;
    std::vector<double> exact;  ///< by component
    std::size_t component = 0;  ///< that gives most
    double uncertainty = 0;     ///< its difference to half the order
    int parts = 1;
};

std::vector<double> exact_sums(const EmittedFunction& function, const HemisphereJob& job,
                               std::span<const DirectionNode> nodes)
{
    EmittedFunction::Batch points{function.inputs().columns()};
    add_points(function.inputs(), job, nodes, points);
    return sums(nodes, function.exact(points), 0);
}

Prepared prepare(const EmittedFunction& function, const HemisphereJob& job)
{
    Prepared out;
    for (;; out.parts *= 2) {
        const EntryInputs& inputs = function.inputs();
        out.nodes = nodes_of(inputs, job, {fine_order, out.parts});
        out.exact = exact_sums(function, job, out.nodes);
        out.component =
            static_cast<std::size_t>(std::ranges::max_element(out.exact) - out.exact.begin());
        const auto coarse = nodes_of(inputs, job, {coarse_order, out.parts});
        const double exact = out.exact[out.component];
        out.uncertainty = std::abs(exact - exact_sums(function, job, coarse)[out.component]);
        const bool enough = out.uncertainty <= wanted * std::abs(exact);
        if (enough || 4 * out.nodes.size() > most_nodes) return out;
    }
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
        jobs_.push_back(prepare(function_, job));
        add_points(function_.inputs(), job, jobs_.back().nodes, points_);
    }

    bool full() const { return points_.size() >= batch_size; }

    std::string finish()
    {
        ResultColumns emitted;
        if (std::string why = function_.emitted(points_, emitted); !why.empty()) return why;
        const ResultColumns at_floats = function_.exact_at_floats(points_);
        std::size_t first = 0;
        for (const Prepared& job : jobs_) {
            HemisphereIntegral& integral = out_.emplace_back();
            integral.exact = job.exact[job.component];
            integral.value = sum(job.nodes, emitted[job.component], first);
            const double rounded = sum(job.nodes, at_floats[job.component], first);
            // The sums are of as many doubles as there are nodes.
            const double summed = static_cast<double>(job.nodes.size()) * 0x1p-53 * integral.exact;
            integral.uncertainty =
                job.uncertainty + std::abs(rounded - integral.exact) + std::abs(summed);
            first += job.nodes.size();
        }
        return {};
    }

private:
    EmittedFunction& function_;
    std::vector<HemisphereIntegral>& out_;
    std::vector<Prepared> jobs_;
    EmittedFunction::Batch points_{function_.inputs().columns()};
};

}  // namespace

std::vector<DirectionNode> light_nodes(double cos_view, double alpha, bool symmetric,
                                       Fineness fineness)
{
    const double view = std::acos(cos_view);
    const double finest = std::max(alpha / 4, 0x1p-16);
    // v.l = 0 meets the horizon at a right angle to v; its circle ends at pi/2 - view.
    const std::array polar{NarrowPlace{view, finest}, NarrowPlace{pi / 2, finest},
                           NarrowPlace{pi / 2 - view, 0x1p-6}};
    const auto nodes = [&](double high, std::span<const NarrowPlace> places) {
        return gauss_legendre(divided(graded_cells(0, high, places), fineness.parts),
                              fineness.order);
    };
    std::vector<DirectionNode> out;
    for (const QuadratureNode& theta : nodes(pi / 2, polar)) {
        const double sine = std::sin(theta.at), cosine = std::cos(theta.at);
        // A half vector tilted sideways by some angle turns the light by twice that times v.h.
        const double near =
            std::max(finest, std::abs(theta.at - view) / 2) * std::max(cos_view, finest);
        std::vector<NarrowPlace> around{{pi, near / std::max(sine, near / pi)}};
        const double across = -cosine * cos_view / (sine * std::sin(view));
        if (std::abs(across) < 1) around.push_back({std::acos(across), 0x1p-6});
        for (const QuadratureNode& phi : nodes(pi, around)) {
            const double weight = theta.weight * sine * phi.weight;
            const double x = sine * std::cos(phi.at), y = sine * std::sin(phi.at);
            // Without a tangent frame both sides of the plane of view are alike.
            out.push_back({{x, y, cosine}, symmetric ? 2 * weight : weight});
            if (!symmetric) out.push_back({{x, -y, cosine}, weight});
        }
    }
    return out;
}

std::vector<DirectionNode> facet_nodes(double alpha_x, double alpha_y, Fineness fineness)
{
    const std::array ends{NarrowPlace{0, 0x1p-4}, NarrowPlace{1, 0x1p-10}};
    const int azimuths = 4 * fineness.order * fineness.parts;
    const std::vector<double> cells = divided(graded_cells(0, 1, ends), fineness.parts);
    std::vector<DirectionNode> out;
    for (const QuadratureNode& u : gauss_legendre(cells, fineness.order)) {
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
    const Prepared prepared = prepare(function, job);
    EmittedFunction::Batch batch{function.inputs().columns()};
    add_points(function.inputs(), job, prepared.nodes, batch);
    return std::ranges::max(sums(prepared.nodes, function.allowed(batch), 0));
}

}  // namespace lobe::analyze
