#version 450 core
#include <pass>
#include <scattering/key.glsl>
#include <scattering/lines.glsl>

// mm; the flag says whether there is surface.
vec4 place_at(ivec2 p) {
#if defined(HAS_DEPTH)
    float depth_m = texelFetch(depth, p, 0).r;
    return vec4(view_position(view_lines(), vec2(p) + 0.5, depth_m), depth_m > 0.0 && depth_m < 1e30 ? 1.0 : 0.0);
#elif defined(HAS_POSITION)
    vec3 position_m = texelFetch(position, p, 0).rgb;
    return vec4(param.world_unit * position_m, position_m != vec3(0.0) ? 1.0 : 0.0);
#else
    return vec4(0.0);
#endif
}

void main() {
    ivec2 p = ivec2(gl_FragCoord.xy);
    vec3 light = texelFetch(irradiance, p, 0).rgb;
    vec4 here = place_at(p);
    bool scatters = here.w > 0.0 && may_scatter(p, light);
    out_place = scatters ? uvec4(floatBitsToUint(here.xyz), key_at(p)) : uvec4(0u);
}
