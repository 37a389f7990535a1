// Devices are listed with what there is to know, and chosen by number or by name.
#include "device/device.h"

#include <catch2/catch.hpp>

#include <string>

using namespace lobe::device;

namespace {

std::string upper(std::string text)
{
    for (char& c : text)
        if (c >= 'a' && c <= 'z') c = static_cast<char>(c - 'a' + 'A');
    return text;
}

}  // namespace

TEST_CASE("every device has a name, a driver and an API version")
{
    std::string why;
    const auto devices = list_devices(why);
    INFO("a Vulkan driver is needed, mesa-vulkan-drivers for example: " << why);
    REQUIRE_FALSE(devices.empty());
    for (const DeviceFacts& facts : devices) {
        CHECK_FALSE(facts.name.empty());
        CHECK_FALSE(facts.driver.empty());
        CHECK(facts.api.substr(0, 2) == "1.");
    }
}

TEST_CASE("a device is found by number, by part of its name, and by default")
{
    std::string why;
    const auto devices = list_devices(why);
    REQUIRE_FALSE(devices.empty());
    for (std::size_t i = 0; i < devices.size(); ++i) {
        const auto device = Device::open(std::to_string(i), why);
        REQUIRE(device);
        CHECK(device->facts().name == devices[i].name);
    }
    const std::string part = upper(devices.back().name.substr(1, 6));
    const auto named = Device::open(part, why);
    REQUIRE(named);
    CHECK(upper(named->facts().name).find(part) != std::string::npos);

    const auto by_default = Device::open({}, why);
    REQUIRE(by_default);
    bool any_software = false;
    for (const DeviceFacts& facts : devices) any_software = any_software || facts.software;
    CHECK(by_default->facts().software == any_software);
}

TEST_CASE("a selector that fits nothing is answered with what there is")
{
    std::string why;
    const auto devices = list_devices(why);
    REQUIRE_FALSE(devices.empty());
    for (const std::string selector : {"voodoo", "999"}) {
        why.clear();
        CHECK_FALSE(Device::open(selector, why));
        CHECK(why.find("`" + selector + "`") != std::string::npos);
        CHECK(why.find("0 " + devices[0].name) != std::string::npos);
    }
}
