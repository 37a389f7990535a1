// Results kept between runs, by their content: what the same inputs gave before, they give again.
//
// The key says everything a result depends on: the SPIR-V or the tape, the driver, the options. The
// analysis never sees where results are kept; without a store everything is computed.
#pragma once

#include <functional>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>

namespace lobe::analyze {

/// Both may be called from any thread.
struct Store {
    std::function<std::optional<std::string>(std::string_view key)> load;
    std::function<void(std::string_view key, std::string_view value)> save;
};

/// The value kept under a key, or what `make` makes, kept from now on.
template <class Make>
std::string kept(const Store& store, std::string_view key, Make make)
{
    if (store.load)
        if (auto found = store.load(key)) return std::move(*found);
    std::string made = make();
    if (store.save) store.save(key, made);
    return made;
}

}  // namespace lobe::analyze
