#version 450 core
#include <pass>

// Means of means, each of four by a tree, so that what is uniform stays so to the bit.
void main() {
    ivec2 corner = ivec2(gl_FragCoord.xy) * 4, last = ivec2(color_size.xy) - 1;
    vec4 light = vec4(0.0);
    float radius = 0.0;
    for (int y = 0; y < 4; ++y) {
        vec4 row[4];
        float row_coc[4];
        for (int x = 0; x < 4; ++x) {
            ivec2 p = min(corner + ivec2(x, y), last);
            row[x] = texelFetch(color, p, 0);
            row_coc[x] = texelFetch(coc, p, 0).r;
        }
        light += (row[0] + row[1]) + (row[2] + row[3]);
        radius += (row_coc[0] + row_coc[1]) + (row_coc[2] + row_coc[3]);
    }
    out_quarter = light / 16.0;
    out_quarter_coc = radius / 16.0;
}
