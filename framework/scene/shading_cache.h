// How often light is computed when the visibility samples of a picture ask a cache for their shading samples.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

namespace aftershade::scene {

enum class ShadingCache {
    global,  ///< each id is shaded once
    tile,    ///< once in each tile that it shows in
    sorted,  ///< the same, by sorting the ids of a tile (Clarberg, Toth and Munkberg 2013)
    lru,     ///< a cache of some entries that drops what was not used for longest (Ragan-Kelley et al. 2011)
    fifo     ///< or what came first (Liktor and Dachsbacher 2012)
};

/// "global", "tile", "sorted", "lru", "fifo"; nullopt for anything else.
std::optional<ShadingCache> parse_shading_cache(std::string_view name);

struct ShadingCacheSettings {
    ShadingCache cache = ShadingCache::global;
    int tile_px = 16;    ///< side of a tile
    int entries = 1024;  ///< lru and fifo
};

/// The ids that the samples of a picture met, kNoShading where nothing: `samples` of each pixel, row by row.
struct SampleIds {
    std::span<const std::uint32_t> ids;
    int width_px = 0;
    int height_px = 0;
    int samples = 0;
    /// Where a pixel has another number of them: the index of each pixel's first, and the end.
    std::span<const std::size_t> first = {};

    std::size_t pixel_count() const { return std::size_t(width_px) * std::size_t(height_px); }
    std::size_t first_of(std::size_t pixel) const {
        return first.empty() ? pixel * std::size_t(samples) : first[pixel];
    }
    std::span<const std::uint32_t> of_pixel(std::size_t pixel) const {
        return ids.subspan(first_of(pixel), first_of(pixel + 1) - first_of(pixel));
    }
};

struct CacheCounts {
    std::uint64_t requests = 0;     ///< samples that met a surface
    std::uint64_t shadings = 0;     ///< misses
    std::uint64_t bytes = 0;        ///< of the cache itself, the largest it was
    std::vector<float> of_pixel{};  ///< shadings: each divided among the samples that used it
};

/// Samples come tile by tile, the pixels of a tile row by row.
CacheCounts replay(const SampleIds& samples, const ShadingCacheSettings& settings);

/// A set of ids in which each has a number: how many smaller ones there are. [const functions: any thread]
class IdSet {
public:
    IdSet(std::span<const std::uint32_t> ids, std::uint32_t id_count);
    std::uint32_t size() const { return before_.back(); }
    std::uint32_t number_of(std::uint32_t id) const;
    std::vector<std::uint32_t> ids() const;  ///< ascending
    /// Bit i of word w is set where id 64 w + i is in the set.
    const std::vector<std::uint64_t>& bits() const { return bits_; }
    /// How many ids come before each word, and at the end all of them.
    const std::vector<std::uint32_t>& before() const { return before_; }

private:
    std::vector<std::uint64_t> bits_;
    std::vector<std::uint32_t> before_;
};

}  // namespace aftershade::scene
