#version 450 core
#include <pass>
#include <lighting/lighting.glsl>
#include <scattering/facet.glsl>
#include <scattering/result.glsl>

// Share that comes through, by the profile's Gaussians (Jimenez and others 2010, equation 6).
vec3 through(ScatteringProfileRow row, float mm) {
    vec3 sum = vec3(0.0);
    for (int k = 0; k < SCATTERING_PROFILE_GAUSSIANS; ++k)
        sum += scattering_profile_weight(row, k) * exp(-mm * mm / max(scattering_profile_variance(row, k), 1e-12));
    return sum;
}

// Metres; 0 where none is known.
float thickness_at(ivec2 at, uint key) {
#ifdef HAS_THICKNESS
    // It may come in a size of its own.
    return texelFetch(thickness, ivec2(gl_FragCoord.xy * thickness_size.xy / vec2(frame.size)), 0).r;
#elif defined(HAS_BEHIND_DEPTH)
#if defined(HAS_BEHIND_OBJECT_ID) && defined(HAS_OBJECT_ID)
    if (texelFetch(behind_object_id, at, 0).r + 1u != key) return 0.0;
#endif
    if (key == 0u) return 0.0;
    ViewLines lines = view_lines();
    Facet here = read_facet(lines, at);
    float along_axis_m = texelFetch(behind_depth, at, 0).r - here.depth_m;
    // Along the line of sight a slab seen at a slant is thicker than it is.
    return along_axis_m * abs(dot(here.normal, view_line(lines, gl_FragCoord.xy)));
#else
    return 0.0;
#endif
}

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    uint key = texelFetch(facet, at, 0).r;
    vec4 light = texelFetch(irradiance, at, 0);
    vec3 n = texelFetch(normal, at, 0).xyz;
    float thickness_m = thickness_at(at, key);
    vec3 position_m = world_position_m(gl_FragCoord.xy, texelFetch(surface, at, 0).a);
    vec3 behind = vec3(0.0);
    for (int i = 0; i < light_count(); ++i) {
        Arriving one = arriving(i, position_m);
        if (one.toward != vec3(0.0)) behind += one.light * clamp(param.wrap - dot(n, one.toward), 0.0, 1.0);
    }
    float mm = thickness_m * param.thickness_scale * param.world_unit;
    vec3 more = behind * through(scattering_profile(key - 1u), min(mm, 1e9));
    out_irradiance = thickness_m > 0.0 ? scattered_result(at, light.rgb + more) : light;
}
