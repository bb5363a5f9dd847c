// Written out by hand: the plotting libraries of Debian 12 (PLplot, plotutils, MathGL; sciplot and
// gnuplot-iostream start gnuplot) draw in fixed colours, which are not legible on both a light and a dark
// page, and none is smaller than this file.
#include "cli/plot.h"

#include <fmt/format.h>

#include <cmath>

#include "framework/base/text.h"

namespace aftershade::cli {

namespace {

constexpr double kWidth = 380, kHeight = 240;                       // of a panel's box, px
constexpr double kLeft = 58, kTop = 38, kRight = 18, kBottom = 48;  // around it
constexpr double kHead = 78;

constexpr const char* kStyle = R"(<style>
text { font: 13px system-ui, sans-serif; fill: #24292f; }
.title { font-size: 17px; font-weight: 600; } .head { font-weight: 600; } .small { font-size: 12px; fill: #57606a; }
.page { fill: #ffffff; } .box { fill: none; stroke: #8c959f; } .grid { stroke: #d8dee4; }
.line { fill: none; stroke-width: 2; stroke-linejoin: round; }
.line0 { stroke: #c8321f; } .line1 { stroke: #1a7f37; stroke-dasharray: 7 3; } .line2 { stroke: #0969da; stroke-dasharray: 2 3; }
@media (prefers-color-scheme: dark) {
  text { fill: #e6edf3; } .small { fill: #9198a1; }
  .page { fill: #0d1117; } .box { stroke: #6e7681; } .grid { stroke: #30363d; }
  .line0 { stroke: #ff7b72; } .line1 { stroke: #56d364; } .line2 { stroke: #79c0ff; }
}
</style>
)";

/// Draws one panel with the corner of its box at (x, y).
class PanelWriter {
public:
    PanelWriter(const PlotPanel& panel, double x, double y) : panel_(panel), x_(x), y_(y) {}

    std::string text() {
        out_ += fmt::format("<text class=\"head\" x=\"{}\" y=\"{}\">{}</text>\n", x_, y_ - 12,
                            xml_text(panel_.title));
        out_ += fmt::format("<text x=\"{}\" y=\"{}\" text-anchor=\"middle\">{}</text>\n", x_ + kWidth / 2,
                            y_ + kHeight + 38, xml_text(panel_.x_label));
        for (const double tick : plot_ticks(panel_.x_range, 6)) add_x_tick(tick);
        if (panel_.log_y) {
            const double low = std::log10(panel_.y_range[0]), high = std::log10(panel_.y_range[1]);
            for (double power = std::ceil(low - 1e-9); power <= high + 1e-9; ++power)
                add_y_tick(std::pow(10, power));
        } else {
            for (const double tick : plot_ticks(panel_.y_range, 5)) add_y_tick(tick);
        }
        out_ += fmt::format("<rect class=\"box\" x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\"/>\n", x_, y_,
                            kWidth, kHeight);
        for (std::size_t i = 0; i < panel_.lines.size(); ++i) add_line(i);
        return std::move(out_);
    }

private:
    double across(double x) const {
        return x_ + kWidth * (x - panel_.x_range[0]) / (panel_.x_range[1] - panel_.x_range[0]);
    }
    double along(double y) const {
        const auto scaled = [&](double v) { return panel_.log_y ? std::log10(v) : v; };
        const double low = scaled(panel_.y_range[0]), high = scaled(panel_.y_range[1]);
        return y_ + kHeight * (1 - (scaled(y) - low) / (high - low));
    }

    void add_x_tick(double tick) {
        out_ += fmt::format(
            "<path class=\"grid\" d=\"M{0:.2f} {1}v{2}\"/><text x=\"{0:.2f}\" y=\"{3}\" "
            "text-anchor=\"middle\">{4:.4g}</text>\n",
            across(tick), y_, kHeight, y_ + kHeight + 17, tick);
    }

    void add_y_tick(double tick) {
        out_ += fmt::format(
            "<path class=\"grid\" d=\"M{0} {1:.2f}h{2}\"/><text x=\"{3}\" y=\"{4:.2f}\" "
            "text-anchor=\"end\">{5:.4g}</text>\n",
            x_, along(tick), kWidth, x_ - 6, along(tick) + 4.5, tick);
    }

    /// What lies outside the ranges is left out: a line that leaves the box ends there.
    void add_line(std::size_t index) {
        const auto& [low, high] = panel_.y_range;
        std::string path;
        bool draws = false;
        for (const auto& [x, y] : panel_.lines[index].points) {
            const bool inside = y >= low && y <= high * (1 + 1e-9);
            if (inside) path += fmt::format("{}{:.2f} {:.2f}", draws ? 'L' : 'M', across(x), along(y));
            draws = inside;
        }
        out_ += fmt::format("<path class=\"line line{}\" d=\"{}\"/>\n", index, path);
    }

    const PlotPanel& panel_;
    double x_, y_;
    std::string out_;
};

std::string legend(const std::vector<PlotLine>& lines) {
    std::string out;
    double x = kLeft;
    for (std::size_t i = 0; i < lines.size(); ++i) {
        out +=
            fmt::format("<path class=\"line line{}\" d=\"M{} 64h26\"/><text x=\"{}\" y=\"68.5\">{}</text>\n",
                        i, x, x + 32, xml_text(lines[i].name));
        x += 62 + 7.2 * double(lines[i].name.size());
    }
    return out;
}

}  // namespace

std::vector<double> plot_ticks(const std::array<double, 2>& range, int count) {
    const double rough = (range[1] - range[0]) / count, power = std::pow(10, std::floor(std::log10(rough)));
    const double step = power * (rough <= power ? 1 : rough <= 2 * power ? 2 : rough <= 5 * power ? 5 : 10);
    std::vector<double> ticks;
    for (double i = std::ceil(range[0] / step - 1e-9); i * step <= range[1] + 1e-9 * step; ++i)
        ticks.push_back(i == 0 ? 0 : i * step);
    return ticks;
}

std::string plot_svg(const std::string& title, const std::string& caption,
                     const std::vector<PlotPanel>& panels) {
    const double column = kLeft + kWidth + kRight, row = kTop + kHeight + kBottom;
    const std::size_t rows = (panels.size() + 1) / 2;
    const double width = column * (panels.size() > 1 ? 2 : 1), height = kHead + row * double(rows);
    std::string out = fmt::format(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0}\" height=\"{1}\" viewBox=\"0 0 {0} "
        "{1}\" role=\"img\">\n<title>{2}</title>\n{3}<rect class=\"page\" width=\"{0}\" "
        "height=\"{1}\"/>\n",
        width, height, xml_text(title), kStyle);
    out += fmt::format(
        "<text class=\"title\" x=\"{0}\" y=\"26\">{1}</text>\n<text class=\"small\" x=\"{0}\" "
        "y=\"46\">{2}</text>\n",
        kLeft, xml_text(title), xml_text(caption));
    if (!panels.empty()) out += legend(panels[0].lines);
    for (std::size_t i = 0; i < panels.size(); ++i) {
        const std::size_t above = i / 2;
        out +=
            PanelWriter(panels[i], kLeft + column * double(i % 2), kHead + kTop + row * double(above)).text();
    }
    return out + "</svg>\n";
}

}  // namespace aftershade::cli
