// Line charts as SVG, in colours for light and for dark pages.
#pragma once

#include <array>
#include <string>
#include <vector>

namespace aftershade::cli {

struct PlotLine {
    std::string name;  ///< in the legend
    std::vector<std::array<double, 2>> points;
};

struct PlotPanel {
    std::string title;
    std::string x_label;
    std::array<double, 2> x_range{0, 1};
    std::array<double, 2> y_range{0, 1};
    bool log_y = false;  ///< y_range then ends at powers of ten
    std::vector<PlotLine> lines;
};

/// At most three lines a panel; each has its own colour and dashes, the same in every panel, named under
/// the title by the first panel's legend. Panels stand two in a row.
std::string plot_svg(const std::string& title, const std::string& caption,
                     const std::vector<PlotPanel>& panels);

/// Numbers 1, 2 or 5 times a power of ten apart, at most about `count`, within a range.
std::vector<double> plot_ticks(const std::array<double, 2>& range, int count);

}  // namespace aftershade::cli
