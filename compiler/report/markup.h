// What pages, pictures and JSON have in common: text and numbers that their formats can hold.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include <string>
#include <string_view>

namespace lobe::report {

/// Text that may stand in HTML, SVG or XML, between tags or quotes.
std::string escaped_xml(std::string_view text);

/// JSON has no word for what is not finite; a string says it.
nlohmann::ordered_json json_number(double value);

}  // namespace lobe::report
