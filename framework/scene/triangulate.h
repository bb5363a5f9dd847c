// A scene as triangles alone, which is what shading samples are numbered over.
#pragma once

#include "framework/scene/scene.h"

namespace aftershade::scene {

/// Triangles about the axis of a sphere, a cylinder or a disk; a sphere has half as many from pole to pole.
/// The outline of a sphere of 50 px is then at most 0.06 px inside the true one.
inline constexpr int kTrianglesAround = 64;

/// The same scene with a mesh in the place of every other shape: outward triangles with the shape's own
/// normals and texture coordinates at their corners. Equal shapes share a mesh.
Scene triangulated(const Scene& scene);

}  // namespace aftershade::scene
