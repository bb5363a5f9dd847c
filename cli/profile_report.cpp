#include "cli/profile_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <nlohmann/json.hpp>
#include <numbers>

#include "cli/plot.h"

namespace aftershade::cli {

namespace {

constexpr std::array<const char*, 3> kChannels = {"red", "green", "blue"};
constexpr std::array<double, 3> kShares = {0.5, 0.9, 0.99};

Rgb by_channel(const std::function<double(int)>& value) {
    return {value(0), value(1), value(2)};
}

Rgb rms_mm(const ScatteringProfile& profile) {
    return by_channel([&](int c) { return std::sqrt(profile.mean_square_mm2(c)); });
}

Rgb radii_mm(const ScatteringProfile& profile, double share) {
    return by_channel([&](int c) { return profile.radius_mm(c, share); });
}

std::string row(const std::string& name, const Rgb& values, const std::string& unit) {
    const std::string numbers = fmt::format("{:>9.4g} {:>9.4g} {:>9.4g}", values[0], values[1], values[2]);
    return fmt::format("  {:<22} {}{}\n", name, numbers, unit.empty() ? "" : "  " + unit);
}

/// The type's own numbers, as the document has them.
std::string own_rows(const ScatteringProfile& profile) {
    using Type = ScatteringProfile::Type;
    if (profile.type == Type::dipole)
        return row("absorption", profile.absorption, "1/mm") +
               row("reduced scattering", profile.scattering, "1/mm") +
               fmt::format("  {:<22} {:>9.4g}\n", "index of refraction", profile.ior);
    if (profile.type == Type::artist)
        return row("falloff", profile.falloff_mm, "mm") +
               row("strength", by_channel([&](int c) { return 1 - profile.direct[std::size_t(c)]; }), "");
    std::string rows;
    for (std::size_t k = 0; k < profile.gaussians.size(); ++k)
        rows += row(fmt::format("Gaussian {} variance", k + 1), profile.gaussians[k].variance_mm2, "mm^2") +
                row("           weight", profile.gaussians[k].weight, "");
    return rows;
}

const std::string& type_of(const ScatteringProfile& profile) {
    return scattering_type_names()[std::size_t(profile.type)];
}

using Curve = std::function<double(int channel, double r_mm)>;

/// Samples closest where r is least.
PlotPanel panel(const std::string& title, const std::string& x_label, double end_mm, const Curve& curve,
                bool mirrored = false) {
    constexpr int kSamples = 240;
    PlotPanel panel{title, x_label, {mirrored ? -end_mm : 0, end_mm}, {0, 0}, false, {}};
    for (int c = 0; c < 3; ++c) {
        PlotLine line{kChannels[std::size_t(c)], {}};
        for (int i = mirrored ? -kSamples : 0; i <= kSamples; ++i) {
            const double t = double(i) / kSamples, r = end_mm * std::max(t * t, 1e-6);
            line.points.push_back({std::copysign(r, t), curve(c, r)});
            panel.y_range[1] = std::max(panel.y_range[1], line.points.back()[1]);
        }
        panel.lines.push_back(std::move(line));
    }
    panel.y_range[1] *= 1.05;
    return panel;
}

/// Whole decades, six of them, from the largest that is finite for all.
void make_logarithmic(PlotPanel& panel) {
    double most = 0;
    for (const PlotLine& line : panel.lines)
        for (const auto& [x, y] : line.points)
            if (x >= 0.005 * panel.x_range[1]) most = std::max(most, y);
    panel.y_range[1] = std::pow(10, std::ceil(std::log10(most)));
    panel.y_range[0] = panel.y_range[1] * 1e-6;
    panel.log_y = true;
}

}  // namespace

std::optional<ScatteringProfile> find_profile(const std::string& what, Diagnostics& diagnostics) {
    const auto shipped = scattering_profile_names();
    if (!what.ends_with(".json") && std::find(shipped.begin(), shipped.end(), what) == shipped.end())
        return std::nullopt;
    Node word;
    word.kind = Node::Kind::string;
    word.string = what;
    word.place = {what};
    return parse_scattering_profile(word, "scattering profile", "", diagnostics);
}

std::string profile_text(const ScatteringProfile& profile) {
    std::string text = profile.name.empty() ? type_of(profile) : profile.name + ": " + type_of(profile);
    if (!profile.summary.empty()) text += "\n" + profile.summary;
    text += fmt::format("\n\n  {:<22} {:>9} {:>9} {:>9}\n", "", kChannels[0], kChannels[1], kChannels[2]) +
            own_rows(profile);
    text += row(profile.type == ScatteringProfile::Type::burley ? "d" : "d of equal rms",
                profile.fitted_d_mm(), "mm");
    if (profile.direct != Rgb{}) text += row("direct", profile.direct, "out where it went in");
    text += row("rms radius", rms_mm(profile), "mm");
    for (const double share : kShares)
        text += row(fmt::format("{:.0f} % within", 100 * share), radii_mm(profile, share), "mm");
    for (const std::string& source : profile.sources) text += "\nsource: " + source;
    return text + (profile.sources.empty() ? "" : "\n");
}

std::string profile_json(const ScatteringProfile& profile) {
    nlohmann::ordered_json radii;
    for (const double share : kShares) radii[fmt::format("{:g}", share)] = radii_mm(profile, share);
    nlohmann::ordered_json document = {{"name", profile.name},          {"summary", profile.summary},
                                       {"sources", profile.sources},    {"type", type_of(profile)},
                                       {"d_mm", profile.fitted_d_mm()}, {"direct", profile.direct},
                                       {"rms_mm", rms_mm(profile)},     {"radius_mm", radii},
                                       {"reach_mm", profile.reach_mm()}};
    return document.dump(2);
}

std::string profile_plot(const ScatteringProfile& profile) {
    const auto widest = [&](double share) {
        const Rgb radii = radii_mm(profile, share);
        return *std::max_element(radii.begin(), radii.end());
    };
    const double end = widest(0.995);
    std::vector<PlotPanel> panels = {
        panel("Share of the light by radius, 2\u03c0 r R(r) [1/mm]", "r [mm]", end,
              [&](int c, double r) { return 2 * std::numbers::pi * r * profile.density(c, r); }),
        panel("Share within a radius", "r [mm]", end, [&](int c, double r) { return profile.within(c, r); }),
        panel("R(r) [1/mm\u00b2]", "r [mm]", end, [&](int c, double r) { return profile.density(c, r); }),
        panel(
            "Light of a line, the 1-D kernel [1/mm]", "x [mm]", widest(0.9),
            [&](int c, double x) { return profile.line_spread(c, x); }, true)};
    panels[1].y_range = {0, 1};
    make_logarithmic(panels[2]);
    // Burley's kernel has no end at 0; what a hundredth of its width lets through is the top of the picture.
    const double end_x = panels[3].x_range[1];
    double most = 0;
    for (int c = 0; c < 3; ++c) most = std::max(most, profile.line_spread(c, 0.01 * end_x));
    panels[3].y_range[1] = 1.1 * most;
    const Rgb d = profile.fitted_d_mm(), rms = rms_mm(profile);
    for (std::size_t c = 0; c < 3; ++c)
        panels[0].lines[c].name = fmt::format("{}: d {:.3g} mm, rms {:.3g} mm", kChannels[c], d[c], rms[c]);
    std::string caption = profile.summary;
    if (profile.direct != Rgb{})
        caption += fmt::format(" At r = 0, not drawn: {:.3g}, {:.3g} and {:.3g}.", profile.direct[0],
                               profile.direct[1], profile.direct[2]);
    return plot_svg("Scattering profile " + (profile.name.empty() ? type_of(profile) : profile.name), caption,
                    panels);
}

}  // namespace aftershade::cli
