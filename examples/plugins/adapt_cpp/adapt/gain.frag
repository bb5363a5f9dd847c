#version 450 core
#include <pass>
void main() {
    vec4 light = texelFetch(color, ivec2(gl_FragCoord.xy), 0);
    out_color = vec4(light.rgb * native.gain, light.a);
}
