#version 450 core
#include <pass>
#include "bright.glsl"
#include "tent.glsl"

void main() {
    vec4 texel = texelFetch(color, ivec2(gl_FragCoord.xy), 0);
    if (param.intensity == 0.0) {
        out_color = texel;
        return;
    }
    // What scatters is taken from where it was.
    out_color = texel + param.intensity * (tent() - bright_part(texel));
}
