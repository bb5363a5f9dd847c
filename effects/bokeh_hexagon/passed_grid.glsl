// The grid as run.vert hands it on.
#include "tile.glsl"
#include "grid.glsl"

layout(location = 0) flat in vec4 grid_axes;
layout(location = 1) flat in vec3 grid_shear_sign;

Grid passed_grid(float spacing) {
    return Grid(spacing, grid_axes.xy, grid_axes.zw, grid_shear_sign.xy, int(grid_shear_sign.z));
}

#ifdef FINE
const float kSpacing = FINE == 1 ? 1.0 : 2.0;

// The tile's texel of `grids` if the point is needed by the grid at hand; else its third and fourth parts are 0.
vec4 grids_at(vec2 position) {
    vec2 last = vec2(frame.size) - 1.0;
    if (any(lessThan(position, vec2(-2.0))) || any(greaterThan(position, last + 3.0))) return vec4(0.0);
    return texelFetch(grids, ivec2(clamp(position, vec2(0.0), last)) / kTile, 0);
}

bool is_needed(vec4 tile) { return (FINE == 1 ? tile.z : tile.w) > 0.0; }
#endif
