#include "engine/golden.h"

#include "engine/diff.h"
#include "engine/models.h"
#include "engine/stand_ins.h"

#include <catch2/catch.hpp>

namespace lobe::engine {

std::string golden_diff()
{
    Request request = wished(plain_wish()).request;
    for (auto& [name, text] : request.files) text = "// What lobe makes of the model.\n";
    const Plan plan = plan_patch(tree_of(engine_tree("4.27")), shipped_list(), request);
    INFO(shown(plan.obstacles));
    REQUIRE(plan.obstacles.empty());
    return unified_diff(plan.changes);
}

}  // namespace lobe::engine
