// The mechanism all passes share: rebuild every function of a module, callees first.
//
// A pass looks at one function at a time and says what each of its expressions becomes. The
// mechanism does the rest: it moves operands, renumbers inputs, drops what is dead, puts the
// inputs in their canonical order and re-wires the calls of a function whose inputs changed.
// Functions keep their ids and their order.
//
// What happens to inputs: those that an expression still reads stay, and so do the arguments of
// the module's roots (those that pack and unpack are among them), whose signature is a promise to
// the caller. An input of another origin (geometry, surface, parameter) that a callee gained is
// handed on from the caller's own input of that origin, which the caller gains in turn.
#pragma once

#include "ir/module.h"

#include <functional>
#include <vector>

namespace lobe::optimize {

/// Where an input of a rebuilt function comes from, for those who call it.
struct Wire {
    enum class Kind : std::uint8_t {
        kept,        ///< was input `index` before
        gained,      ///< of an origin that callers have, or gain
        complement,  ///< one minus what callers passed for input `index`
    };
    Kind kind{};
    std::uint32_t index = 0;  ///< of the old function; unused for `gained`
};

/// One function on its way from the old module to the new one.
class Rebuild {
public:
    Rebuild(const ir::Module& old_module, const ir::Module& new_module,
            const std::vector<std::vector<Wire>>& wires, ir::FunctionId id, bool is_root);

    ir::FunctionId id() const { return id_; }
    bool is_root() const { return is_root_; }
    const ir::Module& old_module() const { return *old_module_; }
    const ir::Function& old() const { return (*old_module_)[id_]; }
    /// A function that was rebuilt before this one, and so anything this one calls.
    const ir::Function& rebuilt(ir::FunctionId callee) const { return (*new_module_)[callee]; }

    /// The new graph, to build in.
    ir::Graph graph;

    /// What an old expression became. Known once the mechanism has passed it.
    ir::ExprId moved(ir::ExprId old_id) const { return moved_[old_id]; }
    std::vector<ir::ExprId> moved_operands(ir::ExprId old_id) const;

    /// The same expression over moved operands; calls are wired to what the callee is now.
    ir::ExprId copy(ir::ExprId old_id);

    /// The same call, of another function that takes arguments of the same names. Its other inputs
    /// are the caller's own, gained where it lacks them. The function comes before this one.
    ir::ExprId call_instead(ir::ExprId old_call, ir::FunctionId callee);

    /// The input of this origin (not `argument`), added if the function lacks it.
    ir::ExprId input(ir::Origin origin, std::uint32_t which);
    ir::ExprId input(ir::GeometryField field);

    /// The argument that carries one minus old input `index`, added right after it if need be.
    ir::ExprId complement_input(std::uint32_t index);

    /// How a caller makes one minus an operand that a callee now asks for. `1 - operand` unless a
    /// pass knows better.
    std::function<ir::ExprId(ir::ExprId old_operand)> complement;

    /// Called when every expression has its place, if a pass has something left to do.
    std::function<void()> finished;

    void place(ir::ExprId old_id, ir::ExprId new_id);
    /// True when nothing would change if every expression became its copy: all is read, and every
    /// callee is called as before.
    bool is_unchanged_by_copies() const;

    /// The function with its dead expressions and unused inputs gone, and how to call it.
    std::pair<ir::Function, std::vector<Wire>> finish();

private:
    struct Slot {
        ir::Input input;
        Wire wire;
    };

    ir::ExprId call(ir::ExprId old_id);
    std::vector<std::uint32_t> canonical_order(const std::vector<bool>& wanted) const;

    const ir::Module* old_module_;
    const ir::Module* new_module_;
    const std::vector<std::vector<Wire>>* wires_;
    ir::FunctionId id_;
    bool is_root_;
    std::vector<Slot> slots_;
    Facts<ir::Expr, ir::ExprId> moved_;
};

/// What each expression of one function becomes: an expression of the same type and, over the
/// real numbers, of the same value. Called in order of ids, for every expression.
using Step = std::function<ir::ExprId(ir::ExprId old_id)>;

/// Looks at a function before it is rebuilt and decides on its step. No step: every expression
/// becomes its copy.
using Pass = std::function<Step(Rebuild&)>;

ir::Module rewrite(const ir::Module& module, const Pass& pass);

template <class Holds>
bool any_expression(const ir::Graph& graph, Holds holds)
{
    for (const ir::ExprId id : graph.ids())
        if (holds(id)) return true;
    return false;
}

/// The module's roots, and the functions that pack and unpack: whatever is called from outside.
std::vector<ir::FunctionId> all_roots(const ir::Module& module);

/// Which functions are among them, by index.
std::vector<bool> root_flags(const ir::Module& module);

/// Equal inputs and, up to the order of ids, spans and the names of lets, equal expressions: what
/// "nothing changed" means.
bool same_function(const ir::Function& f, const ir::Function& g);
bool same_graphs(const ir::Module& a, const ir::Module& b);

}  // namespace lobe::optimize
