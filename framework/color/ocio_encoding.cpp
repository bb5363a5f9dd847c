#include "framework/color/ocio_encoding.h"

#ifdef AFTERSHADE_HAS_OPENCOLORIO
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <vector>

#include "framework/image/luminance.h"

namespace aftershade {

namespace {

using Curve = ColorEncoding::Curve;
using Light = std::array<double, 3>;

constexpr double kTolerance = 2e-3;  // of OpenColorIO's tables for curves

/// Takes numbers of the space to light in Rec. 709's primaries.
class Probe {
public:
    Probe(const ocio::Config& config, const std::string& space, const std::string& target, bool is_display)
        : processor_(config.getProcessor(space.c_str(), target.c_str())->getDefaultCPUProcessor()),
          to_rec709_(conversion_matrix(is_display ? kXyz : *color_space_primaries("ap0"), kRec709)) {}

    Light light(float r, float g, float b) const {
        std::array<float, 3> rgb{r, g, b};
        processor_->applyRGB(rgb.data());
        Light light{};
        for (std::size_t row = 0; row < 3; ++row)
            for (std::size_t k = 0; k < 3; ++k) light[row] += to_rec709_[row * 3 + k] * double(rgb[k]);
        return light;
    }

private:
    ocio::ConstCPUProcessorRcPtr processor_;
    ColorMatrix to_rec709_;
};

/// The curve on which greys lie, as shares of white.
std::optional<ColorEncoding> curve_of(const Probe& probe, double white) {
    std::vector<ColorEncoding> known = {{kRec709, Curve::linear, 1},  {kRec709, Curve::srgb, 1},
                                        {kRec709, Curve::pq, 1},      {kRec709, Curve::hlg, 1},
                                        {kRec709, Curve::gamma, 1.8}, {kRec709, Curve::gamma, 2.2},
                                        {kRec709, Curve::gamma, 2.4}, {kRec709, Curve::gamma, 2.6}};
    for (const ColorEncoding& encoding : known) {
        const double at_white = display_light(1, encoding);
        const auto is_on_curve = [&](float value) {
            const double share = probe.light(value, value, value)[1] / white;
            return std::abs(share - display_light(double(value), encoding) / at_white) <= kTolerance * share;
        };
        if (std::ranges::all_of(std::array{0.1f, 0.25f, 0.5f, 0.75f, 0.9f}, is_on_curve)) return encoding;
    }
    return std::nullopt;
}

/// HLG's display raises the scene's luminance to kHlgGamma, and scales its colours with it.
double without_system_gamma(const Light& light, const Light& white) {
    const auto luminance = [](const Light& of) {
        return std::inner_product(of.begin(), of.end(), kRec709Luminance.begin(), 0.0);
    };
    return std::pow(luminance(light) / luminance(white), 1 / kHlgGamma - 1);
}

bool are_near(const ColorMatrix& a, const ColorMatrix& b) {
    return std::ranges::equal(a, b, [](double x, double y) { return std::abs(x - y) <= kTolerance; });
}

/// The primaries that the matrix converts to Rec. 709. Unless they are of a space with a name, they are given
/// for the white of Rec. 709.
Chromaticities primaries_of(const ColorMatrix& to_rec709) {
    for (const std::string& name : color_space_names())
        if (const Chromaticities known = *color_space_primaries(name);
            are_near(to_rec709, conversion_matrix(known, kRec709)))
            return known;
    const ColorMatrix to_xyz = conversion_matrix(kRec709, kXyz);
    Chromaticities primaries = kRec709;
    for (std::size_t column = 0; column < 3; ++column) {
        Light xyz{};
        for (std::size_t row = 0; row < 3; ++row)
            for (std::size_t k = 0; k < 3; ++k) xyz[row] += to_xyz[row * 3 + k] * to_rec709[k * 3 + column];
        const double sum = xyz[0] + xyz[1] + xyz[2];
        primaries[2 * column] = float(xyz[0] / sum);
        primaries[2 * column + 1] = float(xyz[1] / sum);
    }
    return primaries;
}

}  // namespace

std::optional<ColorEncoding> encoding_of_space(const OcioConfig& open, const std::string& name) {
    const ocio::Config& config = *open.config;
    const auto space = config.getColorSpace(name.c_str());
    if (!space || space->isData()) return std::nullopt;
    const bool is_display = space->getReferenceSpaceType() == ocio::REFERENCE_SPACE_DISPLAY;
    const std::string target =
        is_display ? (config.hasRole("cie_xyz_d65_interchange") ? "cie_xyz_d65_interchange" : "")
                   : ap0_space(config);
    if (target.empty()) return std::nullopt;
    const Probe probe(config, name, target, is_display);
    const Light black = probe.light(0, 0, 0), white = probe.light(1, 1, 1);
    if (!(white[1] > 0) || std::abs(black[1]) > kTolerance * white[1]) return std::nullopt;
    auto encoding = curve_of(probe, white[1]);
    if (!encoding) return std::nullopt;
    ColorMatrix columns{};
    for (std::size_t column = 0; column < 3; ++column) {
        const Light light = probe.light(column == 0, column == 1, column == 2);
        const double factor = encoding->curve == Curve::hlg ? without_system_gamma(light, white) : 1;
        for (std::size_t row = 0; row < 3; ++row) columns[row * 3 + column] = factor * light[row] / white[1];
    }
    for (std::size_t row = 0; row < 3; ++row) {
        const double sum = columns[row * 3] + columns[row * 3 + 1] + columns[row * 3 + 2];
        if (std::abs(sum - white[row] / white[1]) > kTolerance) return std::nullopt;  // not a matrix
    }
    encoding->primaries = primaries_of(columns);
    return encoding;
}

namespace {

/// The encoding for a view whose space is not a curve and a matrix, such as a LUT. Its numbers are for the
/// display, which has a space of its name or a known name.
std::optional<ColorEncoding> encoding_of_display(const OcioConfig& open, const std::string& display,
                                                 const std::string& space_of_view) {
    const auto space = open.config->getColorSpace(space_of_view.c_str());
    if (!space || space->isData()) return std::nullopt;
    if (open.config->getColorSpace(display.c_str())) return encoding_of_space(open, display);
    auto encoding = find_color_encoding(display);
    return encoding && encoding->is_color() && !encoding->is_light() ? encoding : std::nullopt;
}

}  // namespace

std::optional<ColorEncoding> encoding_of_result(const OcioConfig& config, const ColorRequest& request) {
    if (request.inverse) return std::nullopt;
    if (!request.is_view()) return encoding_of_space(config, request.word("destination"));
    const ColorNames names = names_of(config);
    std::string display = request.word("display"), view = request.word("view");
    if (display.empty() && !names.views.empty()) display = names.views.front().first;
    if (view.empty()) view = config.config->getDefaultView(display.c_str());
    std::string space = config.config->getDisplayViewColorSpaceName(display.c_str(), view.c_str());
    if (space == "<USE_DISPLAY_NAME>") space = display;
    if (auto encoding = encoding_of_space(config, space)) return encoding;
    return encoding_of_display(config, display, space);
}

}  // namespace aftershade
#endif
