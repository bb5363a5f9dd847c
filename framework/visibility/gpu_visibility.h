// Visibility samples and shading caches as compute shaders, over a scene's triangles. No buffer is larger
// than 128 MiB: larger pictures are done in bands of rows.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "framework/gpu/context.h"
#include "framework/scene/renderer.h"
#include "framework/scene/shading_cache.h"
#include "framework/scene/shading_grid.h"
#include "framework/scene/visibility.h"

namespace aftershade::visibility {

inline constexpr std::size_t kMaxBufferBytes = std::size_t(128) << 20;

/// What each sample met, as scene::trace_ids() gives it, in single precision: at the edges of triangles and
/// cells some samples have another id. The samples are the renderer's own. Throws Error(ExitCode::usage) for
/// more than 2^20 triangles, and what gpu throws.
std::vector<std::uint32_t> trace_ids(gpu::Context& context, const scene::SceneRenderer& renderer,
                                     const scene::ShadingGrids& grids, int frame,
                                     const scene::VisibilitySettings& settings,
                                     std::size_t max_buffer_bytes = kMaxBufferBytes);

struct CacheCounts {
    std::uint64_t requests = 0;
    std::uint64_t shadings = 0;   ///< with the overflows, which a cache without room shades again
    std::uint64_t overflows = 0;  ///< requests that found no place in their table, or no turn at their bucket
};

/// Shadings of a cache that keeps all: one for the picture, or with `tile_px` above 0 one for each tile.
/// `ids` are below `id_count` or kNoShading.
CacheCounts count_shadings(gpu::Context& context, const scene::SampleIds& samples, std::uint32_t id_count,
                           int tile_px, std::size_t max_buffer_bytes = kMaxBufferBytes);

/// Shadings of a cache of at least `entries` ids in buckets of four, first in, first out. Which requests are
/// hits depends on the order in which invocations run.
CacheCounts count_shadings_in_buckets(gpu::Context& context, const scene::SampleIds& samples, int entries,
                                      std::size_t max_buffer_bytes = kMaxBufferBytes);

}  // namespace aftershade::visibility
