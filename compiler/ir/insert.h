// More functions for a module, in places of their own, or fewer.
//
// Functions are known by their place, callees first, so whoever adds one between others, or takes
// one away, moves the rest. Everything that names a function by its id follows.
#pragma once

#include "ir/module.h"

#include <vector>

namespace lobe::ir {

/// A function and what it comes right behind. Ids in the function (calls, its term) are those of
/// the module before anything was inserted.
struct Insertion {
    FunctionId after;
    Function function;
};

/// The module with all of them; those behind the same function in their order.
Module insert_functions(const Module& module, const std::vector<Insertion>& insertions);

/// The module with these functions alone, by index. Nothing that stays names one that goes, but for
/// a form its term: it is then a term itself.
Module keep_functions(const Module& module, const std::vector<bool>& kept);

}  // namespace lobe::ir
