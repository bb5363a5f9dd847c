// Makes captures of a scene, and the pictures that effects approximate: by rays, in double precision, on the
// CPU. It does not depend on the GL that effects run on, and the same scene gives the same bits for any
// number of threads.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

#include "framework/capture/capture.h"
#include "framework/file/exr_file.h"
#include "framework/scene/world.h"

namespace aftershade::scene {

/// Effects of a true picture that a capture's one ray a pixel lacks.
struct TruthKinds {
    bool lens = false;
    bool shutter = false;
    bool antialias = false;  ///< the mean over the pixel's square
};

enum class TruthMethod {
    accumulation,  ///< every pixel has the same samples (Haeberli and Akeley 1990)
    interleaved    ///< every pixel has its own, in an order of its own (Cook 1986): noise instead of ghosts
};

inline constexpr int kMaxSamples = 65536;

struct TruthSettings {
    TruthKinds kinds;
    TruthMethod method = TruthMethod::accumulation;
    int samples = 256;  ///< 1 to kMaxSamples
    std::uint32_t seed = 0;
    std::array<double, 2> jitter_px{0, 0};
};

struct ScatteringSettings {
    int samples = 2048;        ///< points of the surface for each pixel, about; 64 to kMaxSamples
    bool visible_only = true;  ///< points that the camera sees, which is what an effect has; else all
    std::array<double, 2> jitter_px{0, 0};
};

/// The truth of subsurface scattering.
struct ScatteringTruth {
    Image irradiance;  ///< RGB, E / pi, scattered; of what does not scatter as the capture has it
    Image color;       ///< RGBA: color + albedo * (scattered - unscattered irradiance)
};

/// [const functions: any thread; each uses `threads` of its own]
class SceneRenderer {
public:
    /// `scene` must outlive this. Pixels are square, and the sensor is as wide as the picture.
    SceneRenderer(const Scene& scene, int width_px, int height_px, int threads);

    /// Every role except mask, at `time` in frames; motion is to `time` minus and plus one frame, in the shot
    /// of `frame`. Where the first surface is transparent, color includes the light that shines through; the
    /// other roles are of that surface. `jitter_px` is the samples' offset from the pixels' centres, +y down.
    Capture render_capture(int frame, double time, std::array<double, 2> jitter_px = {0, 0}) const;
    Capture render_capture(int frame) const { return render_capture(frame, frame); }

    /// The same, with the hidden surfaces: layer n has the n-th surface that each ray meets
    /// (World::trace_through), color times its opacity and alpha its opacity, the background behind the last
    /// one, and nothing, alpha 0 and depth +inf, behind that. The last layer includes the light that shines
    /// through it, with alpha 1. The first of one layer is render_capture()'s.
    std::vector<Capture> render_layers(int frame, double time, std::array<double, 2> jitter_px,
                                       int layers) const;
    /// Deep samples: all surfaces that kDeepRays rays over each pixel's square hit. Hits on one object at
    /// nearly one depth are a sample, whose alpha is the share of the rays times the opacity. Channels: R G B
    /// A Z ZBack, velocity.XY, velocity_next.XY, normal.XYZ, object_id.I. The background is an opaque sample
    /// at +inf.
    DeepImage render_deep(int frame, double time, std::array<double, 2> jitter_px) const;
    static constexpr int kDeepRays = 16;

    /// One sample of a pixel: its ray, and the scene at the sample's own moment.
    using SampleVisitor = std::function<void(int x, int y, int sample, const World& world, const Ray& ray)>;
    /// Every sample of every pixel that render_truth() takes. Rows on several threads, the samples of a pixel
    /// in their order.
    void for_each_sample(int frame, const TruthSettings& settings, const SampleVisitor& visit) const;

    /// RGBA. For the shutter, sample i of n is the middle of part i of the exposure, or for interleaved
    /// samples one of 16 moments in that part; lens and pixel are multi-jittered. Without `antialias` rays go
    /// through the pixels' centres, moved by `jitter_px`.
    Image render_truth(int frame, const TruthSettings& settings) const;

    /// Light scattered by each material's profile: the integral of profile times irradiance over the surface
    /// of the object that the pixel shows, divided by that of the profile alone, so that even light stays as
    /// it is. Points lie on spirals about the pixel's own, where light and shadows are computed again: on
    /// planes, disks and spheres exactly, elsewhere where a line along the normal meets the object (King et
    /// al. 2013).
    ScatteringTruth render_scattering(int frame, const ScatteringSettings& settings) const;

    /// Roles of one object over its texture coordinates, `side_px` square: color, irradiance, albedo,
    /// specular, emission, normal, position and object_id; 0 where no surface has them. Highlights are those
    /// of the frame's camera.
    Capture render_texture_space(int frame, int object, int side_px) const;

    /// The scene at the moments that sample `sample` of every pixel chooses from, at most kMomentsOfSample.
    static constexpr int kMomentsOfSample = 16;
    std::vector<World> moments_of(int frame, const TruthSettings& settings, int sample) const;
    struct PixelSample {
        std::size_t moment = 0;  ///< index into moments_of()
        Ray ray;
    };
    /// `moments` are moments_of() of the same sample.
    PixelSample sample_of(int frame, const TruthSettings& settings, int sample, int x, int y,
                          const std::vector<World>& moments) const;

    Ray camera_ray(const CameraState& camera, const glm::dvec2& pixel, const glm::dvec2& lens_m) const;
    /// Where the pinhole camera sees a point (w 1) or a direction (w 0), px; false behind it.
    bool project(const CameraState& camera, const glm::dvec4& point, glm::dvec2& pixel) const;
    double pixels_per_tangent(const CameraState& camera) const;
    /// Textures are filtered over the part of a pixel that one of its samples has.
    World world_at(int frame, double time, double samples_of_px = 1) const;

    const Scene& scene() const { return scene_; }
    const Geometry& geometry() const { return geometry_; }
    int width_px() const { return width_px_; }
    int height_px() const { return height_px_; }
    int threads() const { return threads_; }

private:
    /// From the frame before and to the one after, px; 0 where a point is behind a camera.
    struct Motion {
        glm::dvec2 velocity_px{0};
        glm::dvec2 velocity_next_px{0};
    };
    Motion motion_of(const std::array<const SceneState*, 3>& states, const Surface* surface,
                     const glm::dvec3& direction) const;
    void write_hit(Capture& capture, int x, int y, const World& world, const Surface& surface, const Ray& ray,
                   bool is_last) const;
    struct SamplePoint {
        glm::dvec2 offset_px{0};  ///< from the pixel's top left
        glm::dvec2 on_lens{0};    ///< over the aperture's radius, +y down
    };
    Ray sample_ray(const CameraState& camera, int x, int y, const SamplePoint& point) const;
    SamplePoint sample_point(const TruthSettings& settings, int index, std::uint32_t seed) const;

    const Scene& scene_;
    Geometry geometry_;
    int width_px_;
    int height_px_;
    int threads_;
};

}  // namespace aftershade::scene
