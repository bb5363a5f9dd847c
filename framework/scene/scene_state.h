// A scene at one moment: everything that moves, resolved.
#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "framework/image/camera.h"
#include "framework/scene/scene.h"

namespace aftershade::scene {

struct LightState {
    glm::dvec3 position_m{0};
    glm::dvec3 direction{0, 0, -1};  ///< unit length, the way the light shines; 0 of a point light
    glm::dvec3 half_u_m{0};          ///< area: from the centre to the middle of a side
    glm::dvec3 half_v_m{0};
    glm::dvec3 color_intensity{0};
    bool operator==(const LightState&) const = default;
};

struct CameraState {
    glm::dmat4 camera_from_world{1};  ///< view space: right-handed, looks along -z, y up
    glm::dmat4 world_from_camera{1};
    double focal_length_mm = 50;
    double focus_distance_m = 5;
    double aperture_radius_m = 0;
};

struct SceneState {
    std::vector<glm::dmat4> world_from_object;  ///< as Scene::objects
    std::vector<LightState> lights;             ///< as Scene::lights
    CameraState camera;
};

/// `time` is in frames and may lie outside the frame: in a shot of its own before and after (Shot).
SceneState state_at(const Scene& scene, int frame, double time);

/// As a capture's metadata declares it: the lens at `state`, lens model `pinhole` (rays through a thin lens
/// whose picture lies in the focal plane), both matrices; clip space has z in [0, 1] from 0.01 m to infinity.
Camera capture_camera(const Scene& scene, const SceneState& state, int width_px, int height_px);

/// Where in frame `frame` the shutter is open: [first, last] in frames.
struct Exposure {
    double first = 0;
    double last = 0;
    /// Middle of part `i` of `count` equal ones.
    double middle(int i, int count) const { return first + (last - first) * (i + 0.5) / count; }
};
Exposure exposure_of(const SceneCamera& camera, int frame);

}  // namespace aftershade::scene
