// Rays of visibility samples as rays.glsl reads them; for the sources of this folder.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "framework/scene/scene_renderer.h"
#include "framework/scene/visibility.h"

namespace aftershade::visibility {

struct GpuRay {
    glm::vec4 origin{0};
    glm::vec4 direction{0};
    glm::vec4 stops{0};
};

struct SampleSettings {
    glm::vec2 size_px{0};
    float px_per_tangent = 0;
    std::uint32_t pixel_count = 0;
    std::uint32_t sample_index = 0;
    std::uint32_t sample_count = 0;
    std::uint32_t transparent = 0;
    std::uint32_t light_count = 0;
    glm::vec4 ambient{0};
    glm::vec4 background{0};
    glm::vec4 camera_right{0};
    glm::vec4 camera_up{0};
};

/// All but the sample and its pixels.
SampleSettings sample_settings(const scene::SceneRenderer& renderer, const scene::CameraState& reference,
                               int samples);

/// The rays of sample `sample` through the pixels of some rows. `moments` are those of the sample.
std::vector<GpuRay> rays_of_band(const scene::SceneRenderer& renderer, int frame,
                                 const scene::VisibilitySettings& settings, int sample,
                                 const std::vector<scene::World>& moments, int first_row, int rows);

}  // namespace aftershade::visibility
