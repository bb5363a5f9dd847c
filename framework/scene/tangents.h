// Frames for normal maps.
#pragma once

#include <cstddef>

#include "framework/scene/mesh.h"

namespace aftershade::scene {

/// Gives Mesh::tangents to the triangles from `first` on, by the texture coordinates of a channel: the
/// direction in which u grows on each triangle, in the plane of the corner's normal, and the mean over the
/// triangles that share the corner, weighted by their angles there, as MikkTSpace does (Mikkelsen 2008, which
/// glTF 2.0 names). Corners that triangles with a mirrored texture share become two. Unlike there, corners
/// that are equal but not the same vertex are not joined. A triangle without an area in texture coordinates
/// adds nothing.
void make_tangents(Mesh& mesh, std::size_t first, int channel);

}  // namespace aftershade::scene
