// Light of shading samples that lives from frame to frame of a sequence.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <unordered_map>
#include <vector>

#include "framework/scene/shading_grid.h"

namespace aftershade::scene {

/// A shading sample keeps its place on the surface, its albedo, its irradiance and which share of each light
/// reaches it. The highlight is computed for each frame's camera. Kept light is what computing it again would
/// give: a sample goes if its object moved, if any light changed, or if a ray that found its light meets the
/// box of something that moved, where that was or where it is. It also goes with its grid (KeptGrids), and
/// after kUnusedFrames frames without a use. [one thread; uses those of the renderer]
class KeptShadings {
public:
    static constexpr std::uint32_t kUnusedFrames = 8;

    /// The grids of the next frame, after which samples are kept that are as they were. The renderers have
    /// the same scene and size each time, and the settings are the same.
    ShadingGrids next_frame(const SceneRenderer& renderer, int frame, const ShadingGridSettings& settings);

    struct Lit {
        std::vector<glm::dvec3> light;      ///< of each id
        std::vector<char> is_new;           ///< whether it was computed now
        std::uint64_t highlight_count = 0;  ///< of kept samples
    };
    /// `ids` are distinct, and `grids` are those of this frame.
    Lit light(const SceneRenderer& renderer, const ShadingGrids& grids, std::span<const std::uint32_t> ids);

    std::size_t size() const { return samples_.size(); }
    std::uint64_t bytes() const { return samples_.size() * bytes_of_sample(lights_); }
    /// The size of a sample in a scene with this many lights.
    static std::uint64_t bytes_of_sample(std::size_t lights);
    /// About how many samples a pixel keeps, with this many visibility samples: in shipped scenes up to 8.
    static double samples_of_pixel(int samples, double shading_rate);

private:
    struct Sample {
        std::uint32_t triangle = 0;  ///< of the whole scene
        std::uint32_t cell = 0;      ///< the id from its triangle's first one
        std::uint32_t ray_id = 0;    ///< the id that its random rays come from
        std::uint32_t last_used = 0;
        Shading shading;
        std::uint64_t key() const { return std::uint64_t(triangle) << 32 | cell; }
    };
    std::span<double> seen_of(std::size_t sample);
    void drop_changed(const SceneRenderer& renderer, const ShadingGrids& grids, int frame);
    void drop(const std::vector<char>& is_stale);
    std::size_t find_or_add(const ShadingGrids& grids, std::uint32_t id, char& is_new);

    std::optional<FrameGrids> earlier_;
    std::uint32_t frames_ = 0;
    std::size_t lights_ = 0;
    std::vector<Sample> samples_;
    std::vector<double> seen_;                                ///< of each sample and light
    std::unordered_map<std::uint64_t, std::uint32_t> index_;  ///< of samples by their keys
};

}  // namespace aftershade::scene
