// Fills the images of a capture, pixel by pixel; for the sources of this folder.
#pragma once

#include <span>
#include <string>

#include "framework/capture/capture.h"
#include "framework/scene/world.h"

namespace aftershade::scene {

/// Every role that the renderer makes.
std::span<const std::string> all_roles();

/// Zero-filled images of the roles, header with windows, frame and profile `native`.
Capture make_capture(int frame, int width_px, int height_px, std::span<const std::string> roles);

// Every role except depth and motion; from several threads for different pixels.
void write_surface(Capture& capture, int x, int y, const Scene& scene, const Surface& surface,
                   const Shading& shading);
/// Over what write_surface() wrote as the surface's color.
void write_color(Capture& capture, int x, int y, const glm::dvec3& premultiplied, double alpha);
void write_motion(Capture& capture, int x, int y, const glm::dvec2& velocity_px,
                  const glm::dvec2& velocity_next_px);
void write_background(Capture& capture, int x, int y, const glm::dvec3& radiance);

}  // namespace aftershade::scene
