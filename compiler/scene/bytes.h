// Numbers out of bytes, little-endian as glTF has them, whatever the machine.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string_view>

namespace lobe::scene {

/// The number at `offset`, which with its size has to be in `bytes`.
template <typename Number>
Number load(std::string_view bytes, std::size_t offset)
{
    static_assert(std::endian::native == std::endian::little,
                  "reverse the bytes here for a big-endian machine");
    Number number;
    std::memcpy(&number, bytes.data() + offset, sizeof number);
    return number;
}

}  // namespace lobe::scene
