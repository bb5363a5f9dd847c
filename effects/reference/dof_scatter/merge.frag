#version 450 core
#include <pass>
#include "slices.glsl"

// Front to back, until the pixel is covered; where the capture knows too little of what lies behind, what is there stands
// for the rest.
void main() {
    ivec2 p = ivec2(gl_FragCoord.xy);
    vec4 light = vec4(0.0);
    float open = 1.0, covered = 0.0;
    for (int slice = 0; slice < kSlices && open > 0.0; ++slice) {
        float here = texelFetch(coverage, ivec3(p, slice), 0).r;
        if (here <= 0.0) continue;
        float taken = min(here, open);
        light += taken / here * texelFetch(slices, ivec3(p, slice), 0);
        covered += taken;
        open -= taken;
    }
    out_color = covered > 0.0 ? light / covered : texelFetch(color, p, 0);
}
