// Reads the first instructions of a module; see the SPIR-V specification, sections 2.3 and 3.
#include "device/declared.h"

namespace lobe::device {
namespace {

constexpr std::size_t header_words = 5;
constexpr std::uint32_t magic = 0x07230203;
constexpr std::uint32_t op_entry_point = 15;
constexpr std::uint32_t op_capability = 17;
constexpr std::uint32_t capability_float16 = 9;
constexpr std::uint32_t model_compute = 5;

/// Whether the words begin with this name: four characters each, the first in the lowest bits,
/// a zero after the last.
bool holds_name(std::span<const std::uint32_t> words, std::string_view name)
{
    for (std::size_t i = 0; i <= name.size(); ++i) {
        if (i / 4 >= words.size()) return false;
        const auto character = static_cast<unsigned char>(words[i / 4] >> (i % 4 * 8) & 0xFFU);
        const auto wanted = i < name.size() ? static_cast<unsigned char>(name[i]) : '\0';
        if (character != wanted) return false;
    }
    return true;
}

}  // namespace

std::optional<Declared> declared_by(std::span<const std::uint32_t> spirv, std::string_view entry)
{
    if (spirv.size() < header_words || spirv.front() != magic) return std::nullopt;
    Declared declared;
    for (auto rest = spirv.subspan(header_words); !rest.empty();) {
        const std::size_t length = rest.front() >> 16U;
        if (length == 0 || length > rest.size()) return std::nullopt;
        const auto words = rest.first(length);
        const std::uint32_t op = words.front() & 0xFFFFU;
        if (op == op_capability && length > 1 && words[1] == capability_float16)
            declared.needs_float16 = true;
        // model, id, name, interface
        if (op == op_entry_point && length > 3 && words[1] == model_compute &&
            holds_name(words.subspan(3), entry))
            declared.has_entry = true;
        rest = rest.subspan(length);
    }
    return declared;
}

}  // namespace lobe::device
