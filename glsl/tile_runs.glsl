// Runs of tiles in a row that a draw of quads covers: first tile, its row, end. Runs, because a draw of many small quads costs
// software GL twice as much as one of few long ones.

// Of a quad's corner gl_VertexID, in NDC; the picture is `size` px.
vec4 run_position(uvec4 run, int tile_px, vec2 size) {
    vec2 p = float(tile_px) * vec2((gl_VertexID & 1) == 0 ? run.x : run.z, run.y + uint(gl_VertexID >> 1));
    return vec4(2.0 * p.x / size.x - 1.0, 1.0 - 2.0 * p.y / size.y, 0.0, 1.0);
}
