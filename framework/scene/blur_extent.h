// How far lens and shutter spread a triangle, for shading no finer than what remains visible.
#pragma once

#include <array>
#include <glm/glm.hpp>

#include "framework/scene/scene_renderer.h"

namespace aftershade::scene {

/// From px to cells, by what is least blurred of a triangle. Its pixels are a box of variance 1/12 px^2;
/// motion adds d^2 / 12 along its way and a disk of CoC radius r adds r^2 / 4 to all sides. A cell is as many
/// times longer than a pixel as the standard deviation grows, with half of the blur counted: Vaidyanathan et
/// al. 2012 likewise derive the rate from the bandwidth that blur leaves, with a margin.
/// `corners` are in the object's space; `ends` are the scene where the exposure begins and ends.
glm::dmat2 cells_from_px_of_blur(const SceneRenderer& renderer, const CameraState& camera,
                                 const std::array<SceneState, 2>& ends, const glm::dmat4& world_from_object,
                                 int object, const std::array<glm::dvec3, 3>& corners);

}  // namespace aftershade::scene
