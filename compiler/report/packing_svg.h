// The pieces that the SVG file and the page have in common.
#pragma once

#include "report/packing.h"

#include <string>
#include <string_view>

namespace lobe::report {

/// What stands between the tags of an <svg> of this size, in pixels.
struct SvgBody {
    std::string text;
    double width = 0;
    double height = 0;
};
SvgBody layout_body(const Packed& packed);

/// `callisto on ue4`
std::string title_of(const Packed& packed);

}  // namespace lobe::report
