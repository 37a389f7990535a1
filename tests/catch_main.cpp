// The one translation unit that holds Catch2's main, which may have to serve a test that asks for a
// driver's statistics.
#define CATCH_CONFIG_RUNNER

#include "device/statistics.h"

#include <catch2/catch.hpp>

int main(int argc, char** argv)
{
    if (const auto status = lobe::device::serve_statistics(argc, argv)) return *status;
    return Catch::Session().run(argc, argv);
}
