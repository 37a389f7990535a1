#include "analyze/environment/split_sum.h"

#include "analyze/environment/sampling.h"
#include "analyze/physics/quadrature.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>
#include <vector>

// The integrals are taken over l by its angle to the normal, theta, and its azimuth psi from where
// it mirrors v.
//
// psi: with x = tan((theta - theta_v) / 2), e = cos^2((theta + theta_v) / 2), p = x^2 + alpha^2 and
// L = 1 - e + alpha^2 e, the law of cosines for l + v gives
//
//   v.h^2 = e cos^2(psi / 2) + sin^2(psi / 2) / (1 + x^2)
//   D     = alpha^2 v.h^4 (1 + x^2)^2 / (pi (e p cos^2(psi / 2) + L sin^2(psi / 2))^2)
//
// so D alone has its integral over psi in closed form. With Fc, tan(psi / 2) = kappa tan(q),
// kappa^2 = e p / L, makes its peak as wide as the interval; what is left that is narrow, the back
// of the circle, is spread by pi / 2 - q = kappa sinh(s). In s the nearest singularity is pi / 2
// away, so that a rule of 16 nodes on cells of width 2 errs by about 3.4^-32.
//
// theta: x = alpha sinh(u), which makes p = alpha^2 cosh^2(u) wide in u. What V does near the
// horizon is not known: there cells halve until two halves agree with their whole.

namespace lobe::analyze {
namespace {

constexpr int order = 16;
constexpr int most_halvings = 48;
// How much a cell may change when it is halved; what is left then is far less, since a rule of 16
// nodes gains digits by the dozen.
constexpr double tolerance = 1e-13;
constexpr double widest_cell = 2;
// Below, the integral of D Fc, which has a factor of kappa, is nothing.
constexpr double least_kappa = 1e-20;

using Nodes = std::array<double, order>;

struct Rule {
    Nodes at{};  ///< in [-1, 1]
    Nodes weight{};
};

const Rule& rule()
{
    static const Rule result = [] {
        Rule out;
        const std::array ends{-1.0, 1.0};
        const auto nodes = gauss_legendre(ends, order);
        for (std::size_t i = 0; i < nodes.size(); ++i) {
            out.at[i] = nodes[i].at;
            out.weight[i] = nodes[i].weight;
        }
        return out;
    }();
    return result;
}

/// What does not depend on psi, at one theta.
struct Ring {
    double facing = 0;  ///< 1 + x^2
    double e = 0;
    double p = 0;
    double far = 0;  ///< L
    double cos_i = 0;
    double sin_i = 0;
};

Ring ring(double x, double alpha, double cos_o, double sin_o)
{
    Ring out;
    out.facing = 1 + x * x;
    const double cos_half = cos_o - x * sin_o;
    const double sin_half = x * cos_o + sin_o;
    out.cos_i = std::clamp((cos_half - x * sin_half) / out.facing, 0.0, 1.0);
    out.sin_i = std::clamp((sin_half + x * cos_half) / out.facing, 0.0, 1.0);
    out.e = cos_half * cos_half / out.facing;
    out.p = x * x + alpha * alpha;
    out.far = sin_half * sin_half / out.facing + alpha * alpha * out.e;
    return out;
}

/// The integral of D over psi, all around.
double facets(const Ring& at, double alpha)
{
    const double rest = (1 - alpha) * (1 + alpha);
    const double spread = rest * std::sqrt(at.e / (at.p * at.far));
    return 2 * alpha * alpha * (1 + spread * (2 + rest / 2 * (at.e / at.far + 1 / at.p)));
}

/// The integral of D Fc over psi, all around.
double tail(const Ring& at, double alpha)
{
    const double kappa2 = at.e * at.p / at.far;
    const double kappa = std::sqrt(kappa2);
    if (kappa < least_kappa) return 0;
    const double far_end = at.p / at.far;
    const double last = std::asinh(std::numbers::pi / 2 / kappa);
    const double cells = std::ceil(last / widest_cell);
    const double half = last / cells / 2;
    double sum = 0;
    for (double cell = 0; cell < cells; ++cell)
        for (std::size_t i = 0; i < order; ++i) {
            const double s = half * (2 * cell + 1 + rule().at[i]);
            const double grown = std::exp(s);
            const double sine = std::sin(kappa / 2 * (grown - 1 / grown));
            const double cos2 = sine * sine;
            const double flattened = cos2 + (1 - cos2) * kappa2;
            const double q = far_end + (at.facing - far_end) * cos2;
            const double v_dot_h = std::min(std::sqrt(at.e * q / (at.facing * flattened)), 1.0);
            const double miss = 1 - v_dot_h;
            const double miss2 = miss * miss;
            const double rate = kappa / 2 * (grown + 1 / grown);
            sum += rule().weight[i] * rate * q * q / flattened * miss2 * miss2 * miss;
        }
    return 4 * alpha * alpha / std::numbers::pi * kappa / (at.p * at.p) * half * sum;
}

}  // namespace

ScaleAndBias split_sum(const Visibility& visibility, double roughness, double cos_o)
{
    const double alpha = roughness * roughness;
    const double sin_o = std::sqrt((1 - cos_o) * (1 + cos_o));
    // theta = 0 and theta = 90 degrees.
    const double first = std::asinh(-std::sqrt((1 - cos_o) / (1 + cos_o)) / alpha);
    const double last = std::asinh(cos_o / (1 + sin_o) / alpha);

    const auto cell = [&](double low, double high) {
        const double half = (high - low) / 2;
        const double middle = std::midpoint(low, high);
        std::array<Ring, order> rings;
        Nodes slope_rates;
        Nodes cosines;
        for (std::size_t i = 0; i < order; ++i) {
            const double u = middle + half * rule().at[i];
            rings[i] = ring(alpha * std::sinh(u), alpha, cos_o, sin_o);
            slope_rates[i] = alpha * std::cosh(u);
            cosines[i] = rings[i].cos_i;
        }
        Nodes v;
        visibility.values(roughness, cos_o, cosines, v);
        ScaleAndBias inside;
        for (std::size_t i = 0; i < order; ++i) {
            const Ring& at = rings[i];
            // dtheta = 2 dx / (1 + x^2)
            const double shared =
                rule().weight[i] * v[i] * at.cos_i * at.sin_i * 2 * slope_rates[i] / at.facing;
            const double bias = shared * tail(at, alpha);
            inside.scale += shared * facets(at, alpha) - bias;
            inside.bias += bias;
        }
        return ScaleAndBias{half * inside.scale, half * inside.bias};
    };
    struct Open {
        double low, high;
        ScaleAndBias whole;
        int halvings;
    };
    ScaleAndBias sum;
    std::vector<Open> open{{first, last, cell(first, last), 0}};
    while (!open.empty()) {
        const Open at = open.back();
        open.pop_back();
        const double middle = std::midpoint(at.low, at.high);
        const ScaleAndBias left = cell(at.low, middle);
        const ScaleAndBias right = cell(middle, at.high);
        const ScaleAndBias halves{left.scale + right.scale, left.bias + right.bias};
        const double change = std::max(std::fabs(halves.scale - at.whole.scale),
                                       std::fabs(halves.bias - at.whole.bias));
        if (change <= tolerance || at.halvings == most_halvings) {
            sum.scale += halves.scale;
            sum.bias += halves.bias;
        } else {
            open.push_back({middle, at.high, right, at.halvings + 1});
            open.push_back({at.low, middle, left, at.halvings + 1});
        }
    }
    return sum;
}

ScaleAndBias sampled_split_sum(const Visibility& visibility, double roughness, double cos_o,
                               std::uint32_t samples)
{
    const double alpha = roughness * roughness;
    const Vector v{std::sqrt((1 - cos_o) * (1 + cos_o)), 0, cos_o};
    std::vector<double> cosines(samples);
    std::vector<double> weights(samples);  // v.h / n.h
    std::vector<double> tails(samples);
    for (std::uint32_t i = 0; i < samples; ++i) {
        const Vector h = importance_sample_ggx(hammersley(i, samples), alpha);
        const double v_dot_h = std::clamp(dot(v, h), 0.0, 1.0);
        cosines[i] = std::clamp(mirrored(v, h).z, 0.0, 1.0);
        weights[i] = v_dot_h / h.z;
        tails[i] = std::pow(1 - v_dot_h, 5);
    }
    std::vector<double> visibilities(samples);
    visibility.values(roughness, cos_o, cosines, visibilities);
    ScaleAndBias sum;
    for (std::uint32_t i = 0; i < samples; ++i) {
        // G / n.v = 4 V n.l; a light below the horizon gives nothing.
        if (cosines[i] == 0) continue;
        const double both = 4 * visibilities[i] * cosines[i] * weights[i];
        sum.scale += (1 - tails[i]) * both;
        sum.bias += tails[i] * both;
    }
    return {sum.scale / samples, sum.bias / samples};
}

}  // namespace lobe::analyze
