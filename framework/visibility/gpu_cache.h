// Shading caches as compute shaders. No buffer is larger than 128 MiB: larger pictures are done in bands of
// rows.
#pragma once

#include <cstddef>
#include <cstdint>

#include "framework/scene/shading_cache.h"
#include "framework/visibility/bands.h"
#include "framework/visibility/passes.h"

namespace aftershade::visibility {

struct CacheCounts {
    std::uint64_t requests = 0;
    std::uint64_t shadings = 0;   ///< with the overflows, which a cache without room shades again
    std::uint64_t overflows = 0;  ///< requests that found no place in their table, or no turn at their bucket
};

struct FilledCache {
    CacheCounts counts;
    /// Samples fetch the light that the cache has for them; overflows, light of their own.
    scene::CacheReplay replay;
};

/// A cache that keeps all: one for the picture, or with `tile_px` above 0 one for each tile. `ids` are below
/// `id_count` or kNoShading.
FilledCache fill_tables(Passes& passes, const scene::SampleIds& samples, std::uint32_t id_count, int tile_px,
                        std::size_t max_buffer_bytes = kMaxBufferBytes);

/// A cache of at least `entries` ids in buckets of four, first in, first out. The pixels of a band ask tile
/// by tile, as in scene::replay(); `tile_px` is 1 or more. Which requests are hits depends on the order in
/// which invocations run.
FilledCache fill_buckets(Passes& passes, const scene::SampleIds& samples, int entries, int tile_px,
                         std::size_t max_buffer_bytes = kMaxBufferBytes);

}  // namespace aftershade::visibility
