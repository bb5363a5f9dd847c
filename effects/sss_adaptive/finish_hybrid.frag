#version 450 core
#include <pass>
#include <scattering/result.glsl>

void main() {
    ivec2 p = ivec2(gl_FragCoord.xy);
    float share = texelFetch(sampled, p, 0).r, scattered = texelFetch(plan, p, 0).z;
    vec3 drawn = texelFetch(RESULT, p, 0).rgb, smooth_light = texelFetch(blurred, p, 0).rgb;
    if (scattered < 1.0) smooth_light = mix(texelFetch(surface, p, 0).rgb, smooth_light, scattered);
    if (scattered == 0.0) smooth_light = texelFetch(surface, p, 0).rgb;
    out_irradiance = scattered_result(p, share == 1.0 ? drawn : share == 0.0 ? smooth_light : mix(smooth_light, drawn, share));
}
