// A term V, the part of a microfacet BRDF that depends on n.l, n.v and roughness alone, as
// something to integrate: V_SmithGGX, V_SmithGGXCorrelated, V_SchlickGGX or a model's own.
#pragma once

#include "evaluate/tape.h"
#include "ir/module.h"

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace lobe::analyze {

/// V = G / (4 n.l n.v) [Karis13b], by a term's own tape in double. May be asked by many threads.
class Visibility {
public:
    /// Nothing, and `why` in words, unless the term's result is one number and its inputs are
    /// among `roughness`, `alpha`, the geometry's cos_i and cos_o (or arguments of these names),
    /// and parameters, which are held at their defaults.
    static std::optional<Visibility> of(const ir::Module& module, ir::FunctionId term,
                                        std::string& why);

    /// At a roughness in [1/64, 1], alpha its square; one value per `cos_i`.
    void values(double roughness, double cos_o, std::span<const double> cos_i,
                std::span<double> out) const;

private:
    enum class Feed {
        roughness,
        alpha,
        cos_i,
        cos_o,
        fixed
    };
    struct Slot {
        Feed feed{};
        double fixed = 0;
    };

    evaluate::Tape tape_;
    std::vector<Slot> slots_;
};

}  // namespace lobe::analyze
