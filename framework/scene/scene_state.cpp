#include "framework/scene/scene_state.h"

#include <algorithm>
#include <glm/gtc/matrix_transform.hpp>

#include "framework/image/camera_matrix.h"

namespace aftershade::scene {

namespace {

constexpr double kNear_m = 0.01;

glm::dmat4 turned(const glm::dvec3& rotation_deg) {
    const glm::dvec3 angle_rad = glm::radians(rotation_deg);
    const glm::dmat4 x = glm::rotate(glm::dmat4(1), angle_rad.x, glm::dvec3(1, 0, 0));
    const glm::dmat4 y = glm::rotate(glm::dmat4(1), angle_rad.y, glm::dvec3(0, 1, 0));
    const glm::dmat4 z = glm::rotate(glm::dmat4(1), angle_rad.z, glm::dvec3(0, 0, 1));
    return z * y * x;
}

/// A vector across `direction`, level where that is possible.
glm::dvec3 level_across(const glm::dvec3& direction) {
    const glm::dvec3 up(0, 1, 0);
    const glm::dvec3 across = glm::cross(direction, up);
    return glm::length(across) > 1e-6 ? glm::normalize(across) : glm::dvec3(1, 0, 0);
}

LightState light_at(const Light& light, const Shot& shot, double time) {
    LightState state;
    state.position_m = light.position_m.at(time, shot);
    state.color_intensity = light.color * std::max(light.intensity.at(time, shot), 0.0);
    if (light.kind == LightKind::point) {
        state.direction = glm::dvec3(0);
        return state;
    }
    const glm::dvec3 way = light.target_m.at(time, shot) - state.position_m;
    state.direction = glm::length(way) > 0 ? glm::normalize(way) : glm::dvec3(0, -1, 0);
    const glm::dvec3 u = level_across(state.direction);
    state.half_u_m = u * light.size_m.x * 0.5;
    state.half_v_m = glm::cross(u, state.direction) * light.size_m.y * 0.5;
    return state;
}

CameraState camera_at(const SceneCamera& camera, const Shot& shot, double time) {
    CameraState state;
    const glm::dvec3 position_m = camera.position_m.at(time, shot);
    const glm::dvec3 way = camera.target_m.at(time, shot) - position_m;
    const glm::dvec3 back = glm::length(way) > 0 ? -glm::normalize(way) : glm::dvec3(0, 0, 1);
    const glm::dvec3 right = level_across(-back);
    const glm::dmat4 look(glm::dvec4(right, 0), glm::dvec4(glm::cross(back, right), 0), glm::dvec4(back, 0),
                          glm::dvec4(position_m, 1));
    const double roll_rad = glm::radians(camera.roll_deg.at(time, shot));
    state.world_from_camera = look * glm::rotate(glm::dmat4(1), -roll_rad, glm::dvec3(0, 0, 1));
    state.camera_from_world = glm::inverse(state.world_from_camera);
    state.focal_length_mm = camera.focal_length_mm.positive_at(time, shot);
    state.focus_distance_m = camera.focus_distance_m.positive_at(time, shot);
    state.aperture_radius_m = state.focal_length_mm * 1e-3 / camera.f_number * 0.5;
    return state;
}

}  // namespace

SceneState state_at(const Scene& scene, int frame, double time) {
    const Shot shot = scene.shot_of(frame);
    SceneState state;
    state.world_from_object.reserve(scene.objects.size());
    for (const Object& object : scene.objects) {
        const glm::dmat4 parent =
            object.parent < 0 ? glm::dmat4(1) : state.world_from_object[std::size_t(object.parent)];
        const glm::dmat4 moved = glm::translate(glm::dmat4(1), object.position_m.at(time, shot)) *
                                 turned(object.rotation_deg.at(time, shot));
        state.world_from_object.push_back(parent * glm::scale(moved, object.scale.positive_at(time, shot)));
    }
    for (const Light& light : scene.lights) state.lights.push_back(light_at(light, shot, time));
    state.camera = camera_at(scene.camera, shot, time);
    return state;
}

Camera capture_camera(const Scene& scene, const SceneState& state, int width_px, int height_px) {
    Camera camera;
    const std::string origin = "scene";
    camera.set("focal_length", state.camera.focal_length_mm, origin);
    camera.set("sensor_width", scene.camera.sensor_width_mm, origin);
    camera.set("focus_distance", state.camera.focus_distance_m, origin);
    camera.set("f_number", scene.camera.f_number, origin);
    camera.set("blades", scene.camera.blades, origin);
    camera.set("rotation", scene.camera.rotation_deg, origin);
    camera.set("shutter_angle", scene.camera.shutter_angle_deg, origin);
    camera.set_lens_model("pinhole", origin);
    const double x_scale = 2 * state.camera.focal_length_mm / scene.camera.sensor_width_mm;
    glm::dmat4 clip_from_camera(0);
    clip_from_camera[0][0] = x_scale;
    clip_from_camera[1][1] = x_scale * width_px / height_px;
    clip_from_camera[2][2] = -1;
    clip_from_camera[2][3] = -1;
    clip_from_camera[3][2] = -kNear_m;
    camera.camera_from_world = camera_matrix(state.camera.camera_from_world);
    camera.ndc_from_world = camera_matrix(clip_from_camera * state.camera.camera_from_world);
    return camera;
}

Exposure exposure_of(const SceneCamera& camera, int frame) {
    const double length = camera.shutter_angle_deg / 360;
    const double first = camera.shutter_phase == ShutterPhase::center ? frame - length / 2
                         : camera.shutter_phase == ShutterPhase::end  ? frame - length
                                                                      : frame;
    return {first, first + length};
}

}  // namespace aftershade::scene
