// Expressions as text: one loop over the ids of a graph.
//
// Comes in: a graph, what its inputs and callees are called here, a dialect. Goes out: local
// definitions in order, and one expression per root. An expression that is used twice, that its
// author named, or whose text would not fit a line becomes a local; everything else stands where
// it is used, with the fewest parentheses that keep its meaning and its order of operations.
#pragma once

#include "emit/namer.h"

#include <set>

namespace lobe::emit {

/// A guarded operation's helper function for one type, to be emitted before its use.
struct Helper {
    ir::Op op{};
    ir::Type type{};
    friend auto operator<=>(const Helper&, const Helper&) = default;
};
using Helpers = std::set<Helper>;

/// What names mean where the text goes.
struct Scope {
    const ir::Module& module;
    const Dialect& dialect;
    const std::vector<std::string>& functions;  ///< the text that calls Module::functions[i]
    std::vector<std::string> inputs;            ///< the text of each input: a name, `surface.f0`
    std::vector<bool> colors;                   ///< which inputs have .r .g .b; may be empty
    Namer namer;                                ///< knows every name in sight; gets the locals
    std::string helper_prefix;
};

/// One line of a body, and the expression's place in its .lobe file.
struct Statement {
    std::string text;
    Span span;
};

struct Text {
    std::string text;
    Precedence precedence = Precedence::primary;
};

struct Body {
    std::vector<Statement> locals;
    std::vector<Text> results;
};

/// `scope.namer` and `helpers` grow.
Body write(Scope& scope, Helpers& helpers, const ir::Graph& graph,
           const std::vector<ir::ExprId>& roots);

/// The name of a helper as it is called: `guarded_power`, `Callisto_GuardedPower`.
std::string helper_name(const Dialect& dialect, std::string_view prefix, ir::Op op);

}  // namespace lobe::emit
