#version 450 core
#include <pass>
#include "near.glsl"

// Mean CoC radius in front of the focus plane. Pixels beyond the edges do not count.
void main() {
    ivec2 corner = ivec2(gl_FragCoord.xy) * kDown;
    ivec2 end = min(corner + kDown, ivec2(coc_size.xy));
    float sum = 0.0;
    for (int y = corner.y; y < end.y; ++y)
        for (int x = corner.x; x < end.x; ++x) sum += near_radius(texelFetch(coc, ivec2(x, y), 0).r);
    out_coc_near = sum / float((end.x - corner.x) * (end.y - corner.y));
}
