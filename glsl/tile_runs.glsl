// Where a pass over a tile list draws: quads over runs of tiles in a row. Runs, because a draw of many small quads costs software
// GL twice as much as one of few long ones.

// Of the corner gl_VertexID of the quad gl_InstanceID, in NDC. A run is its first tile, its row, its end.
vec4 tile_position() {
    uvec4 run = TILE_RUNS[gl_InstanceID];
    vec2 p = float(TILE_SIDE) * vec2((gl_VertexID & 1) == 0 ? run.x : run.z, run.y + uint(gl_VertexID >> 1));
    return vec4(2.0 * p.x / tile_grid_size.x - 1.0, 1.0 - 2.0 * p.y / tile_grid_size.y, 0.0, 1.0);
}
