#version 450 core
#include <pass>
#include <lighting/lighting.glsl>
#include <scattering/result.glsl>

// Share that comes through, by the profile's Gaussians (Jimenez and others 2010, equation 6).
vec3 through(ScatteringProfileRow row, float mm) {
    vec3 sum = vec3(0.0);
    for (int k = 0; k < SCATTERING_PROFILE_GAUSSIANS; ++k)
        sum += scattering_profile_weight(row, k) * exp(-mm * mm / max(scattering_profile_variance(row, k), 1e-12));
    return sum;
}

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    uint key = texelFetch(facet, at, 0).r;
    vec4 light = texelFetch(irradiance, at, 0);
    vec3 n = texelFetch(normal, at, 0).xyz;
    // Thickness may come in a size of its own.
    float thickness_m = texelFetch(thickness, ivec2(gl_FragCoord.xy * thickness_size.xy / vec2(frame.size)), 0).r;
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
