// Integrals over the hemisphere: what is conserved, and what is known to be lost.
//
// Simpson's rule over smooth integrands. Its error falls by 16 when the step halves, so the
// difference of two step sizes bounds the finer one's error.
#include "numeric/library.h"

#include <catch2/catch.hpp>

#include <cmath>
#include <functional>
#include <string_view>

namespace lobe::tests {
namespace {

constexpr double pi = 3.14159265358979323846;

struct Integral {
    double value = 0;
    double error = 0;
};

/// The integral over [0, 1] of a function of many points at once.
Integral integrate(const std::function<std::vector<double>(const std::vector<double>&)>& function)
{
    constexpr int intervals = 1 << 14;
    std::vector<double> nodes;
    for (int i = 0; i <= intervals; ++i) nodes.push_back(static_cast<double>(i) / intervals);
    const std::vector<double> values = function(nodes);
    const auto simpson = [&](int stride) {
        double sum = 0;
        for (int i = 0; i <= intervals; i += stride) {
            const bool end = i == 0 || i == intervals;
            const bool odd = (i / stride) % 2 == 1;
            sum += values[static_cast<std::size_t>(i)] * (end ? 1 : odd ? 4 : 2);
        }
        return sum * stride / (3.0 * intervals);
    };
    const double fine = simpson(1);
    return {fine, std::abs(fine - simpson(2)) + 1e-12};
}

std::vector<double> one(const std::string& model, const std::string& term, const Points& points)
{
    return run<double>(optimized(model), term, points).front();
}

}  // namespace

TEST_CASE("distributions project to the whole surface")
{
    for (const double alpha : {0.25, 0.5, 0.7, 1.0})
        for (const char* term : {"D_BlinnPhong", "D_Beckmann", "D_GGX"}) {
            CAPTURE(term, alpha);
            // D cos dw over the hemisphere is pi D du with u = cos^2.
            const Integral integral = integrate([&](const std::vector<double>& nodes) {
                Points points{{"cos_h", {}}, {"alpha", std::vector<double>(nodes.size(), alpha)}};
                for (const double u : nodes) points[0].second.push_back(std::sqrt(u));
                auto d = one("microfacet", term, points);
                for (double& value : d) value *= pi;
                return d;
            });
            CHECK(integral.error < 1e-6);
            // Near 1 the logarithm of Blinn's power is another by 2^-31 (optimize/near_one.cpp):
            // of at most y log(16 / 15) there.
            const bool is_power = std::string_view{term} == "D_BlinnPhong";
            const double exponent = is_power ? 2 / (alpha * alpha) - 2 : 0;
            const double near_one = 0x1p-31 * exponent * std::log(16.0 / 15);
            CHECK(std::abs(integral.value - 1) <= integral.error + near_one);
        }
}

TEST_CASE("a GGX mirror seen along the normal reflects what is known")
{
    struct Known {
        double alpha;
        double albedo;
    };
    // At alpha 1 it is 1 - ln 2; the other is a quadrature's six digits.
    for (const Known known : {Known{1, 1 - std::log(2.0)}, Known{0.25, 0.915812}}) {
        CAPTURE(known.alpha);
        // dw = 2 pi sin dtheta, theta = t pi / 2.
        const Integral integral = integrate([&](const std::vector<double>& nodes) {
            const std::size_t count = nodes.size();
            Points points{{"l.x", {}},
                          {"l.y", std::vector<double>(count, 0)},
                          {"l.z", {}},
                          {"v.x", std::vector<double>(count, 0)},
                          {"v.y", std::vector<double>(count, 0)},
                          {"v.z", std::vector<double>(count, 1)},
                          {"roughness", std::vector<double>(count, std::sqrt(known.alpha))},
                          {"f0", std::vector<double>(count, 1)}};
            for (const double t : nodes) {
                points[0].second.push_back(std::sin(t * pi / 2));
                points[2].second.push_back(std::cos(t * pi / 2));
            }
            auto f = one("callisto", "specular_cos", points);
            for (std::size_t i = 0; i < count; ++i)
                f[i] *= 2 * pi * std::sin(nodes[i] * pi / 2) * pi / 2;
            return f;
        });
        CHECK(integral.error < 1e-6);
        CHECK(std::abs(integral.value - known.albedo) <= integral.error + 0.5e-6);
    }
}

TEST_CASE("Proxima seen along the normal loses 0.17 alpha")
{
    for (const double alpha : {0.01, 0.25, 1.0}) {
        CAPTURE(alpha);
        // dw = 2 pi dc, with v.l = c: the integrand is linear.
        const Integral integral = integrate([&](const std::vector<double>& nodes) {
            const std::size_t count = nodes.size();
            Points points{{"cos_i", nodes},
                          {"cos_o", std::vector<double>(count, 1)},
                          {"v_dot_l", nodes},
                          {"alpha", std::vector<double>(count, alpha)},
                          {"diffuse_color", std::vector<double>(count, 1)}};
            auto f = one("callisto", "proxima_cos", points);
            for (double& value : f) value *= 2 * pi;
            // At the horizon the gate is closed; the limit from above belongs to the integral.
            f[0] = 2 * 0.19 * alpha;
            return f;
        });
        CHECK(std::abs(integral.value - (1 - 0.17 * alpha)) <= integral.error);
    }
}

}  // namespace lobe::tests
