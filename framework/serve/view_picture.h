// The views of a frame on the page: the result, the picture before the steps, a tap or a role in false
// colour; and their numbers.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include <nlohmann/json.hpp>

#include "framework/capture/capture.h"
#include "framework/image/false_color.h"
#include "framework/image/image.h"
#include "framework/look/pipeline.h"
#include "framework/render/renderer.h"

namespace aftershade::serve {

/// What a lens draws sharp, and the limits: "sharp:STEP".
inline constexpr std::string_view kSharpView = "sharp:";
/// The final picture of the steps before one: "before:STEP".
inline constexpr std::string_view kBeforeView = "before:";

/// [refers to what the caller keeps]
struct View {
    const std::string& name;  ///< final, before, before:STEP, tap:STEP.TEXTURE, sharp:STEP, role:NAME
    double exposure_ev = 0;
    const FrameResult& result;
    const Capture& capture;
};

struct ShownView {
    Image picture;                  ///< display-referred values over the display window
    nlohmann::ordered_json legend;  ///< of false colours, as legend_json() gives it; null for a picture
};
/// Throws Error(ErrorKind::usage) for what is not there. For "before:STEP" the result is that of the steps
/// before it.
ShownView view_picture(const View& view);

/// {"words": [range and unit, how they are shown], "drawing": "ramp", "wheel" or "none", "colors":
/// ["#440154"] from near to far or around the wheel from right over down, "faults": [{"name", "color"}]}
nlohmann::ordered_json legend_json(const FalseColor& colors);

/// Whether a view's colours stand for numbers, and are not those of a picture.
bool is_false_color(const std::string& name);

/// The distances between which a lens draws points no wider than 1/1500 of the picture's diagonal, m; with
/// infinities where nothing is sharp. `coc` is in the working grid of the capture.
std::pair<double, double> sharp_range_m(const Image& coc, const Capture& capture);

/// The tap of "tap:STEP.TEXTURE", and of "sharp:STEP" the one with the circles of confusion. Throws
/// Error(ErrorKind::usage) where the pipeline has none such.
Tap tap_of(const std::string& view, const Pipeline& pipeline);

/// "m", "px"; "" for pure numbers.
std::string unit_of_role(const RoleId& role);

/// The place of a picture's pixel in the images of a capture.
std::pair<int, int> place_of_pixel(const CaptureHeader& header, int x, int y);

/// {"x", "y", "roles": [{"name", "unit", "values"}]} at a pixel of the display window; without values outside
/// of the data window.
nlohmann::ordered_json probe_json(const Capture& capture, int x, int y);
/// [r, g, b, a] of what the steps made, or null where they made nothing there.
nlohmann::ordered_json result_at(const FrameResult& result, const CaptureHeader& header, int x, int y);

/// The place of the display window nearest to its middle whose depth is finite, from 0 to 1 right and down;
/// nullopt without any.
std::optional<std::pair<double, double>> nearest_surface(const Capture& capture);

nlohmann::ordered_json histogram_json(const Image& picture);

/// The same pixels as encode_png(), and its chunk sRGB, at the fastest level of zlib: a page shows the
/// picture once, where encode_png() packs for small files. `display` has 1, 3 or 4 float channels and is not
/// empty.
std::string quick_png(const Image& display, bool is_srgb);

}  // namespace aftershade::serve
