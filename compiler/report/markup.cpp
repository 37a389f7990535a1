#include "report/markup.h"

#include <nlohmann/json.hpp>

#include <cmath>

namespace lobe::report {

std::string escaped_xml(std::string_view text)
{
    std::string out;
    for (const char c : text) switch (c) {
        case '<': out += "&lt;"; break;
        case '>': out += "&gt;"; break;
        case '&': out += "&amp;"; break;
        case '"': out += "&quot;"; break;
        default: out += c;
        }
    return out;
}

nlohmann::ordered_json json_number(double value)
{
    if (std::isnan(value)) return "nan";
    if (std::isinf(value)) return value > 0 ? "inf" : "-inf";
    return value;
}

}  // namespace lobe::report
