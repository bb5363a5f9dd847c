// Light at shading samples, and pictures out of it, as compute shaders.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "framework/image/image.h"
#include "framework/scene/scene_renderer.h"
#include "framework/scene/shading_cache.h"
#include "framework/scene/shading_grid.h"
#include "framework/visibility/gpu_visibility.h"
#include "framework/visibility/passes.h"

namespace aftershade::visibility {

/// As scene::resolve_light(), in single precision: at the edges of shadows and of checks some shading samples
/// have another light. No buffer is larger than `max_buffer_bytes`: more shading samples are done in slices,
/// larger pictures in bands of rows. Throws Error(ErrorKind::usage) for more than 2^20 triangles, and what
/// gpu throws.
Image resolve_light(Passes& passes, const scene::SceneRenderer& renderer, const scene::ShadingGrids& grids,
                    std::span<const std::uint32_t> ids, const scene::SampleIds& addresses,
                    std::size_t max_buffer_bytes = kMaxBufferBytes);

}  // namespace aftershade::visibility
