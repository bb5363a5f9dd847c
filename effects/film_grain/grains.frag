#version 450 core
#include <pass>
#include "grain_place.glsl"
#include "grain_bytes.glsl"
#include "one_grain.glsl"

// Each grain serves nine pixels or more.
void main() {
    vec3 grain = one_grain(ivec2(gl_FragCoord.xy) + first_grain());
    vec3 code = floor((grain + kMostDeviations) * (65535.0 / (2.0 * kMostDeviations)) + 0.5);
    vec3 high = floor(code * (1.0 / 256.0));
    out_grains = vec4(high * (1.0 / 255.0), 0.0);
    out_grains_low = vec4((code - 256.0 * high) * (1.0 / 255.0), 0.0);
}
