#version 450 core
#include <pass>
#include "near.glsl"

// Beside the edge of a near surface the blurred radius is half of what it is inside: twice that continues the surface's CoC
// across its silhouette and then falls to 0. The rounding of the means must not change a CoC that is the same everywhere.
const float kRounding = 1.0 / 64.0;

void main() {
    ivec2 p = ivec2(gl_FragCoord.xy);
    float own = texelFetch(coc, p, 0).r;
    float unblurred = near_radius(own);
    float blurred = textureLod(coc_near, (vec2(p) + 0.5) / float(kDown) * coc_near_size.zw, 0.0).r;
    float near = min(2.0 * max(unblurred, blurred) - unblurred, param.max_coc_radius);
    out_coc = near > abs(own) + kRounding ? -near : own;
}
