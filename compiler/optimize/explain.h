// What the passes did and did not have to do, by name: for `lobec build --explain`.
#pragma once

#include "ir/module.h"

#include <span>
#include <string_view>
#include <vector>

namespace lobe::optimize {

/// One thing that can be done to an expression. Rules of rules.h have one each.
struct Action {
    enum class Kind : std::uint8_t {
        rewrite,  ///< the same function of real numbers, computed otherwise
        guard,    ///< an argument is kept in the domain of its operation
        needless  ///< a guard that the ranges prove needless, left out
    };
    std::string_view name;
    Kind kind{};
    std::string_view pattern;
    std::string_view replacement;
    std::string_view reason;
};
std::string_view name(Action::Kind kind);

/// All that is not in rules.h, in the order of the passes.
std::span<const Action> actions();
const Action& action(std::string_view name);

/// An action and where it was taken.
struct Note {
    Action action;
    ir::FunctionId function;
    Span span;  ///< of the expression as written
};

/// Where a pass says what it does, if anyone wants to know. Taken to be about expressions that
/// count: a pass says nothing of dead ones.
class Notes {
public:
    Notes() = default;
    explicit Notes(std::vector<Note>& into) : into_{&into} {}

    void add(const Action& what, ir::FunctionId function, const Span& span) const
    {
        if (into_ != nullptr) into_->push_back({what, function, span});
    }
    void add(std::string_view name, ir::FunctionId function, const Span& span) const
    {
        if (into_ != nullptr) add(action(name), function, span);
    }

private:
    std::vector<Note>* into_ = nullptr;
};

/// As `optimize` of optimize.h; tells `notes` pass by pass, functions in order.
ir::Module optimize(const ir::Module& module, std::vector<Note>& notes);

/// As in optimize.h.
ir::Module cancel(const ir::Module& module, const Notes& notes);
ir::Module near_one(const ir::Module& module, const Notes& notes);
ir::Module regroup(const ir::Module& module, const Notes& notes);
ir::Module legalize(const ir::Module& module, const Notes& notes);

}  // namespace lobe::optimize
