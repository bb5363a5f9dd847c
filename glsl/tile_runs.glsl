// Where a pass over a tile list draws: quads over rectangles of tiles. Rectangles, because a draw of many small quads costs software GL
// more than one of few large ones.

// Of the corner gl_VertexID of the quad gl_InstanceID, in NDC. A rectangle is its first tile, and in the halves of the third word the
// column and the row that follow its last one. The fourth word belongs to another list (host/list_tiles.comp).
vec4 tile_position() {
    uvec4 run = TILE_RUNS[gl_InstanceID];
    vec2 p = float(TILE_SIDE) * vec2((gl_VertexID & 1) == 0 ? run.x : run.z & 0xffffu, gl_VertexID < 2 ? run.y : run.z >> 16);
    return vec4(2.0 * p.x / tile_grid_size.x - 1.0, 1.0 - 2.0 * p.y / tile_grid_size.y, 0.0, 1.0);
}
