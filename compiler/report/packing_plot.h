// Error against bits as a plot: one description, drawn in ASCII or SVG. Errors stand on a
// logarithmic axis; an error of 0 stands at its lower end.
#pragma once

#include "report/packing.h"

#include <string>
#include <utility>
#include <vector>

namespace lobe::report {

struct Plot {
    struct Series {
        std::string name;
        char mark = '*';
        bool dashed = false;
        std::vector<std::pair<int, double>> points;  ///< bits, error; by bits
        int chosen = 0;                              ///< bits that were taken; 0: none
    };
    struct Level {
        std::string name;
        double error = 0;
    };
    std::string title;
    std::vector<Series> series;  ///< earlier ones are drawn above later ones
    std::vector<Level> levels;
};

/// Of the whole by bits: measured and predicted, with the limit and 8 linear bits as levels.
Plot trade_plot(const Packed& packed);
/// Of each parameter by bits.
Plot curve_plot(const analyze::Suggestion& suggestion);

/// Empty if there is nothing above 0 to draw.
std::string plot_text(const Plot& plot, const Look& look);
std::string plot_svg(const Plot& plot);

}  // namespace lobe::report
