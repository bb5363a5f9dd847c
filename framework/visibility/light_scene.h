// Where light falls, at the frame's own time, as shade.comp reads it; for the sources of this folder.
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "framework/scene/shading_grid.h"

namespace aftershade::visibility {

/// A triangle that light falls on, and its grid of shading samples.
struct GpuSurface {
    glm::vec4 corner{0};
    glm::vec4 to_second{0};
    glm::vec4 to_third{0};
    std::array<glm::vec4, 3> normals{};
    glm::vec4 px_from_cells{0};
    glm::vec4 grid{0};
};

struct LightSurfaces {
    std::vector<std::uint32_t> starts;  ///< as scene::ShadingGrids::grids()
    std::vector<GpuSurface> surfaces;   ///< the same
};

LightSurfaces make_light_surfaces(const scene::Scene& scene, const scene::ShadingGrids& grids);

}  // namespace aftershade::visibility
