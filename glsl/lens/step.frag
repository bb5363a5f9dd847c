#version 450 core
#include <pass>
#include "highlight.glsl"

const int kColumns = 3;  // whose steps to the right need one more column: four fetches, and no array

float coc_inside(ivec2 p) { return texelFetch(coc, clamp(p, ivec2(0), ivec2(coc_size.xy) - 1), 0).r; }

void main() {
    ivec2 corner = kRepairTile * ivec2(gl_FragCoord.xy) - 1;
    float largest = 0.0, sum = 0.0;
    for (int x = 0; x < kRepairTile + 2; x += kColumns) {
        vec4 above = vec4(0.0);
        for (int y = 0; y < kRepairTile + 2; ++y) {
            ivec2 p = corner + ivec2(x, y);
            vec4 row = vec4(coc_inside(p), coc_inside(p + ivec2(1, 0)), coc_inside(p + ivec2(2, 0)), coc_inside(p + ivec2(3, 0)));
            vec4 step_px = max(vec4(abs(row.yzw - row.xyz), 0.0), y > 0 ? abs(row - above) : vec4(0.0));
            largest = max(largest, max(max(step_px.x, step_px.y), max(step_px.z, step_px.w)));
            above = row;
        }
    }
    out_coc_step = vec2(largest, 0.0);
    if (!is_repaired(largest)) return;
    ivec2 last = ivec2(color_size.xy) - 1;
    for (int y = 1; y <= kRepairTile; ++y)
        for (int x = 1; x <= kRepairTile; ++x) sum += max(amount(texelFetch(color, min(corner + ivec2(x, y), last), 0).rgb), 0.0);
    out_coc_step.g = sum / float(kRepairTile * kRepairTile);
}
