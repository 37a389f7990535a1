// What the shipped edits do, line by line: read the difference when it changes.
#include "engine/golden.h"

#include <catch2/catch.hpp>

#include <fstream>
#include <sstream>

TEST_CASE("the diff of the 4.27 stand-in tree is the one that was read")
{
    std::ifstream file{lobe::engine::golden_path, std::ios::binary};
    std::ostringstream golden;
    golden << file.rdbuf();
    CHECK(lobe::engine::golden_diff() == golden.str());
}
