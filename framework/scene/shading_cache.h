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

/// The ids that the samples of a picture met, or the addresses of their light; kNoShading where they met
/// nothing. `samples` of each pixel, row by row.
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

/// What a cache makes of the samples. It keeps the addresses of shadings, whose light lies beside it, as in
/// Liktor and Dachsbacher 2012; what it has dropped is shaded again at another address.
struct CacheReplay {
    std::uint64_t requests = 0;              ///< samples that met a surface
    std::uint64_t shadings = 0;              ///< misses
    std::uint64_t bytes = 0;                 ///< of the cache itself, the largest it was
    std::vector<float> of_pixel{};           ///< shadings: each divided among the samples that used it
    std::vector<std::uint32_t> ids{};        ///< of each shading, by its address
    std::vector<std::uint32_t> addresses{};  ///< that each sample fetches; kNoShading where it met nothing
};

/// Shadings of each pixel: each that counts, by its address, is divided among the samples that used it.
std::vector<float> shadings_of_pixels(const SampleIds& addresses, std::span<const char> counts);

/// The shadings of a picture as a cache makes and uses them.
class Shadings {
public:
    /// `samples` must outlive this.
    explicit Shadings(const SampleIds& samples);
    /// Its address.
    std::uint32_t add(std::uint32_t id);
    std::uint32_t id_of(std::uint32_t address) const { return replay_.ids[address]; }
    void use(std::uint32_t address, std::size_t sample);
    CacheReplay replay(std::uint64_t cache_bytes) &&;

private:
    const SampleIds& samples_;
    std::vector<std::uint32_t> uses_;
    CacheReplay replay_;
};

/// Samples come tile by tile, the pixels of a tile row by row.
CacheReplay replay(const SampleIds& samples, const ShadingCacheSettings& settings);

}  // namespace aftershade::scene
