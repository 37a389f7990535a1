// Writes what the golden diff would be now: the `regenerate-engine` target. Read the difference
// before committing it.
#include "engine/golden.h"

#include <catch2/catch.hpp>

#include <fstream>

TEST_CASE("write the golden diff")
{
    std::ofstream{lobe::engine::golden_path, std::ios::binary} << lobe::engine::golden_diff();
}
