// A machine without a Vulkan driver. A process of its own, since drivers stay once they are loaded.
#include "device/device.h"

#include <catch2/catch.hpp>

#include <cstdlib>
#include <string>

using namespace lobe::device;

TEST_CASE("without a driver the answer says what to install")
{
    // Two names of one thing; the older loaders know the second.
    setenv("VK_DRIVER_FILES", "/nonexistent/icd.json", 1);
    setenv("VK_ICD_FILENAMES", "/nonexistent/icd.json", 1);
    std::string why;
    CHECK(list_devices(why).empty());
    CHECK(why.find("mesa-vulkan-drivers") != std::string::npos);
    why.clear();
    CHECK_FALSE(Device::open({}, why));
    CHECK(why.find("mesa-vulkan-drivers") != std::string::npos);
}
