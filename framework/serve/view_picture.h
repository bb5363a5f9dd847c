// The views of a frame on the page: the result, the picture before the steps, a tap or a role in false
// colour; and their numbers.
#pragma once

#include <optional>
#include <string>
#include <utility>

#include <nlohmann/json_fwd.hpp>

#include "framework/capture/capture.h"
#include "framework/image/image.h"
#include "framework/look/pipeline.h"
#include "framework/render/renderer.h"

namespace aftershade::serve {

/// [refers to what the caller keeps]
struct View {
    const std::string& name;  ///< final, before, tap:STEP.TEXTURE, role:NAME
    double exposure_ev = 0;
    const FrameResult& result;
    const Capture& capture;
};

/// Display-referred values over the display window. Throws Error(ErrorKind::usage) for what is not there.
Image view_picture(const View& view);

/// Whether a view's colours stand for numbers, and are not those of a picture.
bool is_false_color(const std::string& name);

/// The tap of "tap:STEP.TEXTURE". Throws Error(ErrorKind::usage) where the pipeline has none such.
Tap tap_of(const std::string& view, const Pipeline& pipeline);

/// "m", "px"; "" for pure numbers.
std::string unit_of_role(const std::string& role);

/// {"x", "y", "roles": [{"name", "unit", "values"}]} at a pixel of the display window; without values outside
/// of the data window.
nlohmann::ordered_json probe_json(const Capture& capture, int x, int y);
/// [r, g, b, a] of what the steps made, or null where they made nothing there.
nlohmann::ordered_json result_at(const FrameResult& result, const CaptureHeader& header, int x, int y);

/// The place of the display window nearest to its middle whose depth is finite, from 0 to 1 right and down;
/// nullopt without any.
std::optional<std::pair<double, double>> nearest_surface(const Capture& capture);

nlohmann::ordered_json histogram_json(const Image& picture);

}  // namespace aftershade::serve
