// Pictures through lens and shutter by many visibility samples a pixel, and how often they compute light.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "framework/scene/kept_shadings.h"
#include "framework/scene/scene_renderer.h"
#include "framework/scene/shading_cache.h"
#include "framework/scene/shading_grid.h"
#include "framework/scene/transparency.h"

namespace aftershade::scene {

enum class Visibility {
    memoised,      ///< light once for each shading sample: decoupled sampling (Ragan-Kelley et al. 2011)
    supersampled,  ///< light at every sample (Cook 1986)
    accumulation   ///< the same, and all pixels have the same samples (Haeberli and Akeley 1990)
};

/// "memoised", "supersampled", "accumulation"; nullopt for anything else.
std::optional<Visibility> parse_visibility(std::string_view name);
std::string_view visibility_name(Visibility visibility);

inline constexpr int kMaxVisibilitySamples = 64;

struct VisibilitySettings {
    Visibility visibility = Visibility::memoised;
    int samples = 16;  ///< of pixel, lens and shutter together; 1 to kMaxVisibilitySamples
    std::uint32_t seed = 0;
    std::array<double, 2> jitter_px{0, 0};
    ShadingGridSettings grid;
    ShadingCacheSettings cache;
    TransparencySettings transparency;
    bool keep_shading = false;  ///< ShadingCache::global: from frame to frame of a sequence (KeptShadings)
};

/// Shadings of a pixel.
struct ShadingRate {
    double of_pixels = 0;          ///< mean over the picture
    double of_covered_pixels = 0;  ///< over the area where samples met a surface; supersampling: the samples
    double p95 = 0;                ///< 95 of 100 pixels have at most this
    double multisampled = 0;  ///< of_covered_pixels if each triangle were shaded once for each pixel (MSAA)
};

/// As Liktor and Dachsbacher 2012 count it: 12 bytes of G-buffer for a shading sample (depth, two RGBA8), and
/// for a visibility sample 4 bytes of depth and 4 that refer to its shading sample.
struct VisibilityBytes {
    std::uint64_t visibility = 0;
    std::uint64_t shading = 0;
    std::uint64_t cache = 0;
    std::uint64_t lists = 0;         ///< of transparent surfaces
    std::uint64_t kept = 0;          ///< of samples that live on to the next frame
    std::uint64_t supersampled = 0;  ///< what a G-buffer of all samples would take
};

struct VisibilityReport {
    int frame = 0;
    int samples = 0;
    std::uint64_t requests = 0;        ///< surfaces that samples met: one each, or all that they blend
    std::uint64_t shadings = 0;        ///< requests that the cache had nothing for
    std::uint64_t kept = 0;            ///< shading samples of earlier frames, which are not among those
    std::uint64_t highlights = 0;      ///< of them: computed for this frame's camera, without rays
    std::uint64_t list_nodes = 0;      ///< surfaces in lists
    std::uint64_t list_overflows = 0;  ///< surfaces that no list had room for; those stop samples by chance
    ShadingRate rate;
    VisibilityBytes bytes;
};

struct VisibilityPicture {
    Image color;         ///< RGBA
    Image shading_rate;  ///< shadings, one channel: each divided among the samples that used it
    VisibilityReport report;
};

/// The samples of a picture, as the renderer makes them: those of the interleaved truth of lens, shutter and
/// antialias.
TruthSettings truth_of(const VisibilitySettings& settings);

/// The surface that each sample hit, as in SampleIds: one surface, transparent ones at random.
std::vector<std::uint32_t> trace_ids(const SceneRenderer& renderer, const ShadingGrids& grids, int frame,
                                     const VisibilitySettings& settings);
/// That, or what does the same elsewhere.
using IdTracer = std::function<std::vector<std::uint32_t>(
    const SceneRenderer& renderer, const ShadingGrids& grids, int frame, const VisibilitySettings& settings)>;

/// RGBA: the mean over the samples of each pixel, which is the light at the address that each has, or the
/// background. `ids` are those of the shadings, by address: each is shaded once.
Image resolve_light(const SceneRenderer& renderer, const ShadingGrids& grids,
                    std::span<const std::uint32_t> ids, const SampleIds& addresses);
/// That, or what does the same elsewhere.
using LightResolver = std::function<Image(const SceneRenderer& renderer, const ShadingGrids& grids,
                                          std::span<const std::uint32_t> ids, const SampleIds& addresses)>;

/// replay(), or what does the same elsewhere.
using CacheFiller = std::function<CacheReplay(const SampleIds& samples, const ShadingGrids& grids,
                                              const ShadingCacheSettings& settings)>;

/// Light at every sample, by pixel.
struct LitSamples {
    LitSamples(int width_px, int height_px);
    std::vector<glm::dvec3> sums;  ///< of the samples' light
    std::vector<std::uint32_t> shadings;
    std::vector<std::uint32_t> met;  ///< samples that met a surface
};
LitSamples light_samples(const SceneRenderer& renderer, int frame, const VisibilitySettings& settings);
/// That, or what does the same elsewhere.
using SampleLighter =
    std::function<LitSamples(const SceneRenderer& renderer, int frame, const VisibilitySettings& settings)>;

/// The parts of Visibility::memoised without lists, and of the others.
struct VisibilityPasses {
    IdTracer trace = trace_ids;
    CacheFiller fill = [](const SampleIds& samples, const ShadingGrids&,
                          const ShadingCacheSettings& settings) { return replay(samples, settings); };
    LightResolver resolve = resolve_light;
    SampleLighter light = light_samples;
};

/// `renderer` is of a scene of meshes (triangulated()). All caches give the same picture; they change only
/// the count, and the time. Nothing depends on the number of threads, except the counts that a CacheFiller
/// gives. Lists are for Visibility::memoised, and Transparency::sorted is for the others. `kept` is for
/// Visibility::memoised with ShadingCache::global; it has the samples of the frames that were rendered with
/// it before, and then of this one. Its light does not come from passes.resolve, nor its addresses from
/// passes.fill.
VisibilityPicture render_visibility(const SceneRenderer& renderer, int frame,
                                    const VisibilitySettings& settings, const VisibilityPasses& passes = {},
                                    KeptShadings* kept = nullptr);

}  // namespace aftershade::scene
