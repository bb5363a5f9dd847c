#version 450 core
#include <pass>
#include <texturing/texturing.glsl>

void main() {
    ivec2 p = ivec2(gl_FragCoord.xy);
    vec3 light = texelFetch(irradiance, p, 0).rgb;
    out_irradiance = vec4(light_before(light, texelFetch(albedo, p, 0).rgb), 1.0);
}
