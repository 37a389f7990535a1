#include "analyze/environment/visibility.h"

#include "evaluate/run.h"

#include <fmt/format.h>

#include <algorithm>

namespace lobe::analyze {

std::optional<Visibility> Visibility::of(const ir::Module& module, ir::FunctionId term,
                                         std::string& why)
{
    const ir::Function& function = module[term];
    if (function.type() != ir::Type::scalar) {
        why = fmt::format("`{}` is more than one number, so it is no visibility", function.name);
        return std::nullopt;
    }
    Visibility result;
    result.tape_ = evaluate::compile(module, function);
    for (const evaluate::TapeInput& scalar : result.tape_.inputs) {
        const ir::Input& input = function.inputs[scalar.input];
        if (input.origin == ir::Origin::parameter) {
            const std::vector<double>& standard = module.parameters[input.which].default_value;
            const auto component = static_cast<std::size_t>(scalar.component);
            result.slots_.push_back(
                {Feed::fixed, standard[std::min(component, standard.size() - 1)]});
        } else if (scalar.name == "roughness") {
            result.slots_.push_back({Feed::roughness});
        } else if (scalar.name == "alpha") {
            result.slots_.push_back({Feed::alpha});
        } else if (scalar.name == "cos_i") {
            result.slots_.push_back({Feed::cos_i});
        } else if (scalar.name == "cos_o") {
            result.slots_.push_back({Feed::cos_o});
        } else {
            why = fmt::format("`{}` depends on `{}`, and a visibility only on roughness or alpha, "
                              "cos_i and cos_o",
                              function.name, scalar.name);
            return std::nullopt;
        }
    }
    return result;
}

void Visibility::values(double roughness, double cos_o, std::span<const double> cos_i,
                        std::span<double> out) const
{
    const std::size_t count = cos_i.size();
    std::vector<double> constants(slots_.size() * count);
    std::vector<const double*> inputs;
    for (std::size_t i = 0; i < slots_.size(); ++i) {
        if (slots_[i].feed == Feed::cos_i) {
            inputs.push_back(cos_i.data());
            continue;
        }
        const double value = slots_[i].feed == Feed::roughness ? roughness
                             : slots_[i].feed == Feed::alpha   ? roughness * roughness
                             : slots_[i].feed == Feed::cos_o   ? cos_o
                                                               : slots_[i].fixed;
        double* const column = constants.data() + i * count;
        std::fill_n(column, count, value);
        inputs.push_back(column);
    }
    double* const output = out.data();
    evaluate::run(tape_, inputs, {&output, 1}, count);
}

}  // namespace lobe::analyze
