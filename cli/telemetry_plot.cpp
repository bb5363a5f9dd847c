#include "cli/telemetry_plot.h"

#include <algorithm>
#include <set>
#include <utility>

#include "cli/plot.h"

namespace aftershade::cli {

namespace {

/// From 0, or from below it where values are, to a little above the largest.
std::array<double, 2> range_of(const std::vector<PlotLine>& lines) {
    double low = 0, high = 0;
    for (const PlotLine& line : lines)
        for (const auto& [x, y] : line.points) {
            low = std::min(low, y);
            high = std::max(high, y);
        }
    return {low, high > low ? high + 0.05 * (high - low) : low + 1};
}

PlotPanel panel_of(std::string title, std::array<double, 2> frames, std::vector<PlotLine> lines) {
    PlotPanel panel{std::move(title), "frame", frames, range_of(lines), false, {}};
    panel.lines = std::move(lines);
    return panel;
}

}  // namespace

std::string telemetry_plot(const std::vector<FrameTelemetry>& frames, const std::string& title) {
    std::array<double, 2> range{0, 1};
    if (!frames.empty()) range = {double(frames.front().frame), double(frames.back().frame)};
    if (range[0] == range[1]) ++range[1];
    std::set<std::pair<std::string, std::string>> names;
    for (const FrameTelemetry& frame : frames)
        for (const auto& [step, statistics] : frame.steps)
            for (const auto& [name, statistic] : statistics) names.emplace(step, name);
    std::vector<PlotPanel> panels;
    for (const auto& [step, name] : names) {
        PlotLine mean{"mean", {}}, most{"largest", {}};
        for (const FrameTelemetry& frame : frames) {
            const auto found = frame.steps.find(step);
            if (found == frame.steps.end() || !found->second.contains(name)) continue;
            const Statistic& statistic = found->second.at(name);
            if (statistic.count == 0) continue;
            mean.points.push_back({double(frame.frame), statistic.mean});
            most.points.push_back({double(frame.frame), statistic.max});
        }
        panels.push_back(panel_of(step + "." + name, range, {mean, most}));
    }
    PlotLine time{"sum", {}};
    for (const FrameTelemetry& frame : frames) {
        double sum = 0;
        for (const graph::PassTime& pass : frame.passes) sum += pass.milliseconds;
        time.points.push_back({double(frame.frame), sum});
    }
    panels.push_back(panel_of("all passes, ms", range, {time}));
    return plot_svg("Telemetry of " + title, "Mean and largest over the texels that count.", panels);
}

}  // namespace aftershade::cli
