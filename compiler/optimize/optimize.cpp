#include "optimize/optimize.h"

#include "ir/shade.h"
#include "optimize/decimal.h"
#include "optimize/explain.h"
#include "optimize/stabilize.h"

#include <cassert>

namespace lobe::optimize {

namespace {

ir::Module checked(ir::Module module)
{
    assert(!ir::verify(module));
    return module;
}

/// All passes; tells what they did where asked.
ir::Module run(const ir::Module& module, const Notes& notes, std::vector<Application>& applied)
{
    // So that rules meet x and not x * 1.
    const ir::Module simple = checked(simplify(module));
    // Before quotients are part of anything else.
    const ir::Module reduced = checked(cancel(simple, notes));
    const ir::Module tidy = checked(simplify_again(simple, reduced));
    // While powers are powers and differences stand as they were written.
    const ir::Module stable = checked(stabilize(tidy, applied));
    // What a stable form leaves of numbers is as small as what it was to keep: no float of it.
    const ir::Module exact = checked(fold_decimals(stable));
    // What that folds to, and inputs that nothing reads any more.
    const ir::Module clean = checked(simplify_again(tidy, exact));
    // The powers that no sum took part in.
    const ir::Module sharp = checked(near_one(clean, notes));
    // After all that looks for what the author wrote.
    const ir::Module grouped = checked(regroup(sharp, notes));
    // Late: what it proves is about the expressions that will be emitted.
    const ir::Module legal = checked(legalize(grouped, notes));
    // Factors of 1 in products, and guards that a sharper range makes needless.
    const ir::Module done = checked(simplify_again(clean, legal));
    // When it is known which fields of the geometry the outputs of models ask for.
    return with_shades(done);
}

}  // namespace

ir::Module optimize(const ir::Module& module)
{
    std::vector<Application> applied;
    return run(module, {}, applied);
}

ir::Module optimize(const ir::Module& module, std::vector<Note>& notes)
{
    std::vector<Application> applied;
    std::vector<Note> others;
    ir::Module result = run(module, Notes{others}, applied);
    for (const Application& use : applied)
        notes.push_back({{use.rule->name, Action::Kind::rewrite, use.rule->pattern,
                          use.rule->replacement, use.rule->reason},
                         use.function,
                         use.span});
    notes.insert(notes.end(), others.begin(), others.end());
    return result;
}

}  // namespace lobe::optimize
