#version 450 core
#include <pass>
#include "highlight.glsl"
#include "lens.glsl"

const int kSide = kRepairTile + 2;  // with 1 px around

ivec2 inside(ivec2 p) { return clamp(p, ivec2(0), ivec2(coc_size.xy) - 1); }

// Columns x to x + 3 of a row.
vec4 four(ivec2 p) {
    return vec4(texelFetch(coc, inside(p), 0).r, texelFetch(coc, inside(p + ivec2(1, 0)), 0).r, texelFetch(coc, inside(p + ivec2(2, 0)), 0).r,
                texelFetch(coc, inside(p + ivec2(3, 0)), 0).r);
}

float smallest_of(vec4 v) { return min(min(v.x, v.y), min(v.z, v.w)); }
float largest_of(vec4 v) { return max(max(v.x, v.y), max(v.z, v.w)); }

// A row of the tile, with 1 px to its left and 2 px to its right, in registers: each texel is fetched once.
struct Row { vec4 a, b, c, d, e; };

Row row_at(ivec2 p) {
    Row row = Row(four(p), four(p + ivec2(4, 0)), four(p + ivec2(8, 0)), four(p + ivec2(12, 0)), vec4(0.0));
    for (int i = 0; i < 3; ++i) row.e[i] = texelFetch(coc, inside(p + ivec2(16 + i, 0)), 0).r;
    row.e.w = row.e.z;
    return row;
}

float step_along(Row row) {
    vec4 ab = abs(row.a - vec4(row.a.yzw, row.b.x)), bc = abs(row.b - vec4(row.b.yzw, row.c.x));
    vec4 cd = abs(row.c - vec4(row.c.yzw, row.d.x)), de = abs(row.d - vec4(row.d.yzw, row.e.x));
    vec2 e = abs(row.e.xy - row.e.yz);
    return max(max(largest_of(max(ab, bc)), largest_of(max(cd, de))), max(e.x, e.y));
}

float step_across(Row row, Row above) {
    vec4 ab = max(abs(row.a - above.a), abs(row.b - above.b)), cd = max(abs(row.c - above.c), abs(row.d - above.d));
    return max(largest_of(max(ab, cd)), largest_of(abs(row.e - above.e)));
}

void main() {
    ivec2 corner = kRepairTile * ivec2(gl_FragCoord.xy) - 1;
    Row above = row_at(corner);
    float step_px = step_along(above), smallest = above.a.y, greatest = smallest;
    for (int y = 1; y < kSide; ++y) {
        Row row = row_at(corner + ivec2(0, y));
        step_px = max(step_px, max(step_along(row), step_across(row, above)));
        float low = min(min(smallest_of(min(row.b, row.c)), smallest_of(row.d)), min(min(row.a.y, row.a.z), min(row.a.w, row.e.x)));
        float high = max(max(largest_of(max(row.b, row.c)), largest_of(row.d)), max(max(row.a.y, row.a.z), max(row.a.w, row.e.x)));
        bool is_own = y <= kRepairTile;
        smallest = y == 1 ? low : is_own ? min(smallest, low) : smallest;
        greatest = y == 1 ? high : is_own ? max(greatest, high) : greatest;
        above = row;
    }
    out_coc_step = vec4(step_px, 0.0, smallest, greatest);
    if (!is_repaired(step_px)) return;
    float sum = 0.0, brightest = 0.0;
    for (int y = 0; y < kSide; ++y)
        for (int x = 0; x < kSide; ++x) {
            float light = amount(texelFetch(color, inside(corner + ivec2(x, y)), 0).rgb);
            brightest = max(brightest, light);
            if (x > 0 && x <= kRepairTile && y > 0 && y <= kRepairTile) sum += max(light, 0.0);
        }
    out_coc_step.g = sum / float(kRepairTile * kRepairTile);
#ifndef SHARES_PIXELS
    if (brightest <= kOutshinesTile * out_coc_step.g) out_coc_step.g = kNothingOutshines;
#endif
}
