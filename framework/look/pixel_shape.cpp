#include "framework/look/pixel_shape.h"

#include <algorithm>

#include <fmt/format.h>

#include "framework/effect/manifest/manifest_expand.h"
#include "framework/image/role.h"

namespace aftershade {

namespace {

/// By the sensor's width, which makes pixels of millimetres; by pixels further away than the next; or by a
/// length in px. What averages jittered samples of the same surface over frames needs them where they are: on
/// square pixels, edges at rest have twice the error at an aspect of 2.
bool takes_square_pixels(const EffectManifest& manifest) {
    const auto is_by_sensor = [](const ParamSpec& spec) { return spec.from == "camera.sensor_width"; };
    const auto is_length = [](const ParamSpec& spec) { return spec.unit == "px"; };
    const auto moves = [](const InputSpec& input) { return kind_of_role(input.role) == RoleKind::motion; };
    if (std::ranges::any_of(manifest.params, is_by_sensor)) return true;
    if (const auto& reach = manifest.reach) return reach->is_all || !reach->params.empty() || reach->px > 1;
    if (manifest.has_history() && std::ranges::any_of(manifest.inputs, moves)) return false;
    return !is_pointwise(manifest) || std::ranges::any_of(manifest.params, is_length);
}

}  // namespace

SquareSteps::SquareSteps(const Pipeline& pipeline, const PixelStretch& stretch) : stretch_(stretch) {
    for (const PipelineStep& step : pipeline.steps)
        in_display_window_.push_back(step.manifest->is_in_display_window);
    if (stretch_.is_none()) return;
    const auto needs = [](const PipelineStep& step) { return takes_square_pixels(*step.manifest); };
    const auto& steps = pipeline.steps;
    const auto first = std::ranges::find_if(steps, needs);
    if (first == steps.end()) {
        stretch_ = {};
        return;
    }
    first_ = int(first - steps.begin());
    last_ = int(std::find_if(steps.rbegin(), steps.rend(), needs).base() - steps.begin()) - 1;
}

StepGrid SquareSteps::grid_of(int step, const CaptureHeader& header) const {
    const Window& display = header.display_window;
    const Window& data = is_in_display_window(step) ? display : header.data_window;
    if (!contains(step)) return {data, display, {}};
    return {stretched(data, display, stretch_), stretched(display, display, stretch_), stretch_};
}

std::string SquareSteps::note(const Pipeline& pipeline, const CaptureHeader& header) const {
    if (stretch_.is_none()) return "";
    const Window window = grid_of(first_, header).data_window;
    const auto name = [&](int step) { return "'" + pipeline.steps[std::size_t(step)].name + "'"; };
    return fmt::format("{} on {} x {} square pixels (the capture's pixel aspect is {})",
                       first_ == last_ ? "step " + name(first_) + " works"
                                       : "steps " + name(first_) + " to " + name(last_) + " work",
                       window.width(), window.height(), header.pixel_aspect);
}

}  // namespace aftershade
