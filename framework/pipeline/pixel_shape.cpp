#include "framework/pipeline/pixel_shape.h"

#include <algorithm>
#include <vector>

#include <fmt/format.h>

#include "framework/core/text.h"
#include "framework/image/role.h"

namespace aftershade {

namespace {

/// By the sensor's width, which makes pixels of millimetres, or by a radius around a pixel. Motion has a
/// length of its own along each axis.
bool takes_square_pixels(const EffectManifest& manifest) {
    const auto is_by_sensor = [](const ParamSpec& spec) { return spec.from == "camera.sensor_width"; };
    if (std::ranges::any_of(manifest.params, is_by_sensor)) return true;
    const auto moves = [](const InputSpec& input) { return kind_of_role(input.role) == RoleKind::motion; };
    if (!manifest.reach || std::ranges::any_of(manifest.inputs, moves)) return false;
    return manifest.reach->is_all || !manifest.reach->params.empty() || manifest.reach->px > 1;
}

}  // namespace

std::string square_pixels_warning(const Pipeline& pipeline, float pixel_aspect) {
    if (pixel_aspect == 1 || !(pixel_aspect > 0)) return "";
    std::vector<std::string> steps;
    for (const PipelineStep& step : pipeline.steps)
        if (takes_square_pixels(*step.manifest)) steps.push_back("'" + step.name + "'");
    if (steps.empty()) return "";
    return fmt::format("the capture's pixel aspect is {}, and {} {} as if pixels were square: round shapes are "
                       "{} times as wide as high on the display (resample the frames to square pixels first)",
                       pixel_aspect, joined(steps, " and "),
                       steps.size() == 1 ? "works" : "work", pixel_aspect);
}

}  // namespace aftershade
