// The shading sample that one visibility sample of every pixel of a band meets.
struct Grid {
    vec4 view[3];        // the corners before the reference pose's camera, m; w of the first: the first cell, as bits
    vec4 cells_from_px;  // columns
    vec4 grid;           // low corner, in cells; size, as bits
};
layout(std430, binding = 6) writeonly buffer Ids { uint ids[]; };
layout(std430, binding = 3) readonly buffer Grids { Grid grids[]; };  // of the triangles of all objects

uint id_of(Hit hit) {
    Grid at = grids[hit.surface];
    vec3 view = (1.0 - hit.barycentric.x - hit.barycentric.y) * at.view[0].xyz + hit.barycentric.x * at.view[1].xyz +
                hit.barycentric.y * at.view[2].xyz;
    vec2 px = view.z < 0.0 ? 0.5 * size_px + px_per_tangent * vec2(view.x, -view.y) / -view.z : 0.5 * size_px;
    px = clamp(px, -size_px, 2.0 * size_px);
    ivec2 size = floatBitsToInt(at.grid.zw);
    ivec2 cell = clamp(ivec2(floor(mat2(at.cells_from_px) * px - at.grid.xy)), ivec2(0), size - 1);
    return 2u * (floatBitsToUint(at.view[0].w) + uint(cell.y * size.x + cell.x)) + (hit.from_behind ? 1u : 0u);
}

void main() {
    uint pixel = gl_GlobalInvocationID.x;
    if (pixel >= pixel_count) return;
    Hit hit = stopped(pixel, rays[pixel].origin.xyz, rays[pixel].direction.xyz, floatBitsToUint(rays[pixel].origin.w));
    ids[pixel * sample_count + sample_index] = hit.surface == kNoShading ? kNoShading : id_of(hit);
    check_loops();
}
