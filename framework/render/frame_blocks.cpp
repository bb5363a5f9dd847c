#include "framework/render/frame_blocks.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <glm/glm.hpp>
#include <glm/gtc/matrix_inverse.hpp>

#include "framework/base/error.h"
#include "framework/base/text.h"
#include "framework/capture/cryptomatte.h"
#include "framework/image/camera_matrix.h"

namespace aftershade {

namespace {

ColumnMatrix columns_of(const glm::dmat4& matrix) {
    ColumnMatrix columns;
    for (int column = 0; column < 4; ++column)
        for (int row = 0; row < 4; ++row) columns[std::size_t(column * 4 + row)] = float(matrix[column][row]);
    return columns;
}

struct Projection {
    glm::dmat4 view_from_world;
    glm::dmat4 clip_from_world;
};

/// Distance of the plane that is NDC z = 0; the far plane is infinite (z = 1).
constexpr double kNear_m = 0.01;

/// nullopt where the camera is not known, or not projective. Captures keep x, y and w of the projection only:
/// w becomes the distance along the view axis, and z = w - near.
std::optional<Projection> projection_of(const Camera& camera) {
    if (!camera.camera_from_world || !camera.ndc_from_world) return std::nullopt;
    glm::dmat4 clip = glm_matrix(*camera.ndc_from_world);
    const glm::dvec3 axis(clip[0][3], clip[1][3], clip[2][3]);
    const double scale = glm::length(axis);
    if (!(scale > 1e-12)) return std::nullopt;
    clip /= scale;
    for (int column = 0; column < 4; ++column) clip[column][2] = clip[column][3];
    clip[3][2] -= kNear_m;
    return Projection{glm_matrix(*camera.camera_from_world), clip};
}

void set_matrices(const Camera& camera, CameraBlock& block) {
    const auto projection = projection_of(camera);
    if (!projection) return;
    const glm::dmat4 world_from_view = glm::inverse(projection->view_from_world);
    const glm::dmat4 clip_from_view = projection->clip_from_world * world_from_view;
    block.view_from_world = columns_of(projection->view_from_world);
    block.world_from_view = columns_of(world_from_view);
    block.clip_from_view = columns_of(clip_from_view);
    block.view_from_clip = columns_of(glm::inverse(clip_from_view));
    block.clip_from_world = columns_of(projection->clip_from_world);
    block.world_from_clip = columns_of(glm::inverse(projection->clip_from_world));
    for (int i = 0; i < 3; ++i) block.position_m[i] = float(world_from_view[3][i]);
    block.has_matrices = 1;
}

struct MixBlock {
    float amount = 1;
    std::int32_t invert = 0;
    std::int32_t object_count = 0;
    std::int32_t unused = 0;
    std::int32_t origin_px[2] = {0, 0};
    std::int32_t display_size_px[2] = {1, 1};
    std::uint32_t objects[kMaxMaskObjects][4] = {};  // first and last id; std140 has arrays of vec4
};
static_assert(sizeof(MixBlock) == kMixBlockBytes);

void set_origin(const StepGrid& grid, std::int32_t (&origin_px)[2], std::int32_t (&display_px)[2]) {
    display_px[0] = grid.display_window.width();
    display_px[1] = grid.display_window.height();
    origin_px[0] = grid.data_window.min_x - grid.display_window.min_x;
    origin_px[1] = grid.data_window.min_y - grid.display_window.min_y;
}

}  // namespace

std::uint32_t step_seed(const std::string& name) {
    return fnv1a_32(name);
}

FrameBlock frame_block(const FrameInputs& frame, const StepGrid& grid, const std::string& step,
                       bool history_valid) {
    const CaptureHeader& header = frame.capture->header;
    FrameBlock block;
    set_origin(grid, block.origin_px, block.display_size_px);
    block.number = header.frame;
    block.step_seed = aftershade::step_seed(step);
    block.fps = float(frame.fps);
    block.history_valid = history_valid ? 1 : 0;
    const ColorMatrix matrix = conversion_matrix(header.primaries, kRec709);
    for (std::size_t row = 0; row < 3; ++row)
        for (std::size_t column = 0; column < 3; ++column)
            block.rec709_from_color[column][row] = float(matrix[row * 3 + column]);
    block.size_px[0] = grid.data_window.width();
    block.size_px[1] = grid.data_window.height();
    block.full_display_size_px[0] = int(std::lround(block.display_size_px[0] / frame.scale));
    block.full_display_size_px[1] = int(std::lround(block.display_size_px[1] / frame.scale));
    block.scale = float(frame.scale);
    block.subframe = frame.subframe;
    block.subframe_count = frame.subframe_count;
    block.subframe_time = float((frame.subframe + 0.5) / frame.subframe_count - 0.5);
    return block;
}

CameraBlock camera_block(const FrameInputs& frame, const StepGrid& grid, const FrameBefore& before) {
    const Camera& camera = frame.capture->header.camera;
    CameraBlock block;
    set_matrices(camera, block);
    const Capture* const earlier = frame.at(-1);
    const std::optional<Camera> known = earlier ? std::optional(earlier->header.camera) : before.camera;
    if (const auto previous = known ? projection_of(*known) : std::nullopt) {
        block.prev_clip_from_world = columns_of(previous->clip_from_world);
        block.prev_view_from_world = columns_of(previous->view_from_world);
        if (const auto current = projection_of(camera)) {
            const glm::dmat4 world_from_view = glm::inverse(current->view_from_world);
            block.prev_clip_from_view = columns_of(previous->clip_from_world * world_from_view);
            block.prev_view_from_view = columns_of(previous->view_from_world * world_from_view);
        }
        block.has_prev_matrices = 1;
    }
    const auto set_jitter = [&](const Camera& from, float(&jitter_px)[2]) {
        for (std::size_t i = 0; i < 2 && from.jitter_px; ++i)
            jitter_px[i] = float((*from.jitter_px)[i] * grid.stretch.scale(int(i)));
    };
    set_jitter(camera, block.jitter_px);
    if (known) set_jitter(*known, block.prev_jitter_px);
    block.focal_length_mm = float(camera.get("focal_length").value_or(0));
    block.sensor_width_mm = float(camera.get("sensor_width").value_or(0));
    block.focus_distance_m = float(camera.get("focus_distance").value_or(0));
    block.f_number = float(camera.get("f_number").value_or(0));
    return block;
}

LightsBlock lights_block(const FrameInputs& frame, const std::string& step) {
    const CaptureHeader& header = frame.capture->header;
    LightsBlock block;
    if (header.lights.size() > kMaxShaderLights)
        throw Error(ErrorKind::capture, header.path.string() + ": step '" + step +
                                            "' uses the capture's lights, of which there are " +
                                            std::to_string(header.lights.size()) + "; effects take " +
                                            std::to_string(kMaxShaderLights) +
                                            ". Name those that count in \"lights\" of capture.json");
    block.count = std::int32_t(header.lights.size());
    for (std::size_t i = 0; i < header.lights.size(); ++i) {
        const CaptureLight& light = header.lights[i];
        LightEntry& entry = block.light[i];
        entry.kind = light.kind == CaptureLight::Kind::point         ? 0
                     : light.kind == CaptureLight::Kind::directional ? 1
                                                                     : 2;
        std::copy(light.position_m.begin(), light.position_m.end(), entry.position_m);
        std::copy(light.direction.begin(), light.direction.end(), entry.direction);
        std::copy(light.intensity.begin(), light.intensity.end(), entry.intensity);
        std::copy(light.size_m.begin(), light.size_m.end(), entry.size_m);
    }
    return block;
}

std::vector<std::byte> mix_block(const PipelineStep& step, const StepGrid& grid, const FrameInputs& frame) {
    MixBlock block;
    block.amount =
        float(std::get<double>(evaluate(step.mix, mix_spec(), step.name + ".mix", *frame.capture)));
    set_origin(grid, block.origin_px, block.display_size_px);
    if (!step.mask) return bytes_of(block);
    block.invert = step.mask->invert ? 1 : 0;
    const std::vector<IdRange> ranges = id_ranges(step.mask->objects);
    assert(ranges.size() <= kMaxMaskObjects);
    block.object_count = std::int32_t(ranges.size());
    for (std::size_t i = 0; i < ranges.size(); ++i) {
        block.objects[i][0] = ranges[i].first;
        block.objects[i][1] = ranges[i].last;
    }
    return bytes_of(block);
}

}  // namespace aftershade
