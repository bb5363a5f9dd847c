#version 450 core
#include <pass>
#include <scattering/facet.glsl>
#include <burley.glsl>
#include <luminance.glsl>
#include "past.glsl"

const float kLightChange = 0.1;  // of the larger of two frames' light
const float kMostLevel = 5.0;

// Light that came in where the pixel's scattered light comes from: within the mean radius of the profile, 2.5 d.
float light_around(ViewLines lines, Facet here) {
#if PREFILTER
    vec3 d = scattering_profile(here.key - 1u).d;
    float radius_px = 2.5 * max(d.r, max(d.g, d.b)) * pixels_per_mm(lines, here.depth_m);
    float level = clamp(log2(max(2.0 * radius_px, 1.0)), 0.0, kMostLevel);
    return luminance(textureLod(light, gl_FragCoord.xy * light_size.zw, level).rgb);
#else
    return luminance(here.light);
#endif
}

void main() {
    ivec2 p = ivec2(gl_FragCoord.xy), q;
    out_guided = vec4(0.0);
    out_lit = 0.0;
    Facet here = read_facet(view_lines(), p);
    bool inside = past_pixel(q);
    if (here.key == 0u) return;
    vec3 now = texelFetch(estimate, p, 0).rgb;
    vec4 past = texelFetch(guided_prev, q, 0);
    float lit_now = light_around(view_lines(), here), lit_then = texelFetch(lit_prev, q, 0).r;
    bool same_light = abs(lit_now - lit_then) <= kLightChange * max(lit_now, lit_then);
    bool known = inside && texelFetch(plan, p, 0).y > 0.0 && past.a > 0.0 && same_light;
    // Frames count alike until the newest would count less than its weight.
    float frames = known ? past.a + 1.0 : 1.0;
    float weight = max(1.0 / frames, param.guiding_weight);
    out_guided = vec4(known ? mix(past.rgb, now, weight) : now, 1.0 / weight);
    out_lit = lit_now;
}
