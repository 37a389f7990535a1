// Affine maps, column-major as glTF has them.
#include "scene/matrix.h"

#include <cmath>

namespace lobe::scene {
namespace {

/// A difference of two points, which the translation does not move.
std::array<double, 3> edge(const Matrix& world, const Vector3& from, const Vector3& to)
{
    std::array<double, 3> edge{};
    for (std::size_t column = 0; column < 3; ++column) {
        const double along = static_cast<double>(to[column]) - static_cast<double>(from[column]);
        for (std::size_t row = 0; row < 3; ++row) edge[row] += world[4 * column + row] * along;
    }
    return edge;
}

}  // namespace

Matrix multiply(const Matrix& first, const Matrix& second)
{
    Matrix product{};
    for (std::size_t column = 0; column < 4; ++column)
        for (std::size_t row = 0; row < 4; ++row)
            for (std::size_t inner = 0; inner < 4; ++inner)
                product[4 * column + row] += first[4 * inner + row] * second[4 * column + inner];
    return product;
}

Matrix compose(const std::array<double, 3>& translation, const std::array<double, 4>& rotation,
               const std::array<double, 3>& scale)
{
    const auto [x, y, z, w] = rotation;
    const std::array<std::array<double, 3>, 3> columns{
        {{1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y)},
         {2 * (x * y - w * z), 1 - 2 * (x * x + z * z), 2 * (y * z + w * x)},
         {2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)}}};
    Matrix matrix = identity;
    for (std::size_t column = 0; column < 3; ++column)
        for (std::size_t row = 0; row < 3; ++row)
            matrix[4 * column + row] = columns[column][row] * scale[column];
    for (std::size_t row = 0; row < 3; ++row) matrix[12 + row] = translation[row];
    return matrix;
}

std::optional<double> uniform_scale(const Matrix& map)
{
    const auto dot = [&](std::size_t a, std::size_t b) {
        double sum = 0;
        for (std::size_t row = 0; row < 3; ++row) sum += map[4 * a + row] * map[4 * b + row];
        return sum;
    };
    const double square = dot(0, 0);
    constexpr double slack = 1e-9;
    const bool is_uniform =
        std::abs(dot(1, 1) - square) <= slack * square &&
        std::abs(dot(2, 2) - square) <= slack * square && std::abs(dot(0, 1)) <= slack * square &&
        std::abs(dot(0, 2)) <= slack * square && std::abs(dot(1, 2)) <= slack * square;
    if (!is_uniform) return std::nullopt;
    return std::sqrt(square);
}

double area_of(const Mesh& mesh, const Matrix& world)
{
    double area = 0;
    for (std::size_t at = 0; at + 2 < mesh.triangles.size(); at += 3) {
        const Vector3& corner = mesh.positions[mesh.triangles[at]];
        const auto a = edge(world, corner, mesh.positions[mesh.triangles[at + 1]]);
        const auto b = edge(world, corner, mesh.positions[mesh.triangles[at + 2]]);
        const double x = a[1] * b[2] - a[2] * b[1];
        const double y = a[2] * b[0] - a[0] * b[2];
        const double z = a[0] * b[1] - a[1] * b[0];
        area += std::sqrt(x * x + y * y + z * z) / 2;
    }
    return area;
}

}  // namespace lobe::scene
