// Visibility samples as a compute shader, over a scene's triangles. No buffer is larger than 128 MiB: larger
// pictures are done in bands of rows.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "framework/scene/scene_renderer.h"
#include "framework/scene/shading_grid.h"
#include "framework/scene/visibility.h"
#include "framework/visibility/bands.h"
#include "framework/visibility/passes.h"

namespace aftershade::visibility {

/// What each sample met, as scene::trace_ids() gives it, in single precision: at the edges of triangles and
/// cells some samples have another id. The samples are the renderer's own. Throws Error(ErrorKind::usage) for
/// more than 2^20 triangles, and what gpu throws.
std::vector<std::uint32_t> trace_ids(Passes& passes, const scene::SceneRenderer& renderer,
                                     const scene::ShadingGrids& grids, int frame,
                                     const scene::VisibilitySettings& settings,
                                     std::size_t max_buffer_bytes = kMaxBufferBytes);

}  // namespace aftershade::visibility
