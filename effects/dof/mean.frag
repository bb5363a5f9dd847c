#version 450 core
#include <pass>
#include "tile.glsl"

void main() {
    int rows = texelFetch(lit, 8 * ivec2(gl_FragCoord.xy) / kTile, 0).r > 0.5 ? 8 : 0;
    ivec2 last = ivec2(color_size.xy) - 1, corner = 8 * ivec2(gl_FragCoord.xy);
    float sum = 0.0;
    for (int y = 0; y < rows; ++y)
        for (int x = 0; x < 8; ++x) sum += dot(texelFetch(color, min(corner + ivec2(x, y), last), 0).rgb, vec3(1.0));
    out_mean = sum / 64.0;
}
