// `lobec devices`: what `verify --device` can choose from.
#include "cli/commands.h"
#include "device/device.h"

#include <fmt/format.h>

namespace lobe::cli {

void add_devices(CLI::App& app, const Terminal& terminal, int& status)
{
    auto* command = app.add_subcommand("devices", "List the Vulkan devices that verify can use");
    command->footer("Example: lobec devices");
    command->callback([&terminal, &status] {
        std::string why;
        const auto devices = device::list_devices(why);
        if (devices.empty()) {
            status = fail(terminal, why);
            return;
        }
        for (std::size_t i = 0; i < devices.size(); ++i)
            fmt::print("{}  {}  Vulkan {}, {}, float16 {}\n    {}\n", i, devices[i].name,
                       devices[i].api, devices[i].software ? "software" : "hardware",
                       devices[i].float16 ? "yes" : "no", devices[i].driver);
        status = success;
    });
}

}  // namespace lobe::cli
