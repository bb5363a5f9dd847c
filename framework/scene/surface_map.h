// The surface of a shape by its texture coordinates, for captures in texture space.
#pragma once

#include "framework/image/image.h"
#include "framework/scene/mesh.h"
#include "framework/scene/scene.h"

namespace aftershade::scene {

/// Square RGBA images in object space. Texel (x, y) stands for the surface point with
/// (u, v) = ((x + 0.5) / side, (y + 0.5) / side): v grows down the rows.
struct SurfaceMap {
    Image position;  ///< xyz in m; w is 1 where the surface has a point with that uv, else all is 0
    Image normal;    ///< xyz of unit length, outwards; w as position's
    Image triangle;  ///< of a mesh: a uint; else empty
    Image weights;   ///< of a mesh: those of the triangle's second and third corner
};

/// The texture coordinates of a surface point p = (x, y, z) with the normal n, in object space, where h is
/// Shape::half_size_m and r is h.x. What draws the scene uses the same table.
///
///     plane     u = 0.5 + x / (2 h.x)               v = 0.5 - y / (2 h.y)
///     disk      u = 0.5 + x / (2 r)                 v = 0.5 - y / (2 r)
///     sphere    u = fract(atan2(z, x) / (2 pi))     v = acos(clamp(y / r, -1, 1)) / pi
///     box       u = (column + a) / 3                v = (row + b) / 2
///       face by the axis of the largest |n|, its cell, and a, b in it:
///       +x  column 0, row 0    a = 0.5 - z / (2 h.z)    b = 0.5 - y / (2 h.y)
///       -x  column 1, row 0    a = 0.5 + z / (2 h.z)    b = 0.5 - y / (2 h.y)
///       +y  column 2, row 0    a = 0.5 + x / (2 h.x)    b = 0.5 + z / (2 h.z)
///       -y  column 0, row 1    a = 0.5 + x / (2 h.x)    b = 0.5 - z / (2 h.z)
///       +z  column 1, row 1    a = 0.5 + x / (2 h.x)    b = 0.5 - y / (2 h.y)
///       -z  column 2, row 1    a = 0.5 - x / (2 h.x)    b = 0.5 - y / (2 h.y)
///     cylinder, with half the height h.y
///       side, |n.y| < 0.5:  u = fract(atan2(z, x) / (2 pi))     v = (2 / 3) (0.5 - y / (2 h.y))
///       top, +y:            u = (0.5 + x / (2 r)) / 2           v = (2 + 0.5 + z / (2 r)) / 3
///       bottom, -y:         u = (1 + 0.5 + x / (2 r)) / 2       v = (2 + 0.5 - z / (2 r)) / 3
///     mesh      its vertices' uv
///
/// Each face of a box, and each cap, stands as who looks at it from outside sees it, unmirrored; the sides
/// of a box have y up; a sphere and the side of a cylinder stand mirrored, since u turns from +x to +z. Of a
/// mesh the triangles whose uv hold the texel's centre count, on their edges too; where they overlap the one
/// with the lowest index; coordinates outside 0 to 1 are not wrapped. `mesh` is for ShapeKind::mesh alone, a
/// group covers nothing; side_px from 1.
SurfaceMap make_surface_map(const Shape& shape, const Mesh* mesh, int side_px);

}  // namespace aftershade::scene
