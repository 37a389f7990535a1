#include "analyze/scalar.h"

#include <cstddef>

namespace lobe::analyze {

Scalar scalar_of(const ir::Module& module, const ir::Input& input, int component, const Grid& grid)
{
    Scalar scalar;
    const double low = std::max(input.range.low, -grid.largest);
    const double high = std::min(input.range.high, grid.largest);
    scalar.low = to_grid(low, grid.precision);
    if (scalar.low < low) scalar.low = next_above(scalar.low, grid);
    scalar.high = to_grid(high, grid.precision);
    if (scalar.high > high) scalar.high = next_below(scalar.high, grid);
    // A range that holds no number of the grid: the nearest one must do.
    if (scalar.low > scalar.high) scalar.low = scalar.high = to_grid(low, grid.precision);
    scalar.whole =
        input.quantity == ir::Quantity::integer || input.quantity == ir::Quantity::boolean;
    if (input.quantity == ir::Quantity::boolean) scalar = {0, 1, 0, true, false};
    scalar.parameter = input.origin == ir::Origin::parameter;
    if (scalar.parameter)
        scalar.neutral = std::clamp(
            module.parameters[input.which].default_value[static_cast<std::size_t>(component)],
            scalar.low, scalar.high);
    else
        scalar.neutral = scalar.contains(1) ? 1 : scalar.nearest_to_zero();
    return scalar;
}

std::vector<Scalar> scalars_of(const ir::Module& module, const ir::Function& function,
                               const Grid& grid)
{
    std::vector<Scalar> scalars;
    for (const ir::Input& input : function.inputs)
        for (int k = 0; k < ir::components(input.type); ++k)
            scalars.push_back(scalar_of(module, input, k, grid));
    return scalars;
}

}  // namespace lobe::analyze
