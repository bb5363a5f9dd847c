// The average over frames within the step.
#include <scattering/facet.glsl>
#include <scattering/gathered.glsl>
#include <burley.glsl>
#include <luminance.glsl>
#include "mip_level.glsl"
#include "past.glsl"

const float kLightChange = 0.1;
const float kMostChange = 64.0;  // of what an average can be made brighter or darker by

// Light that came in where the pixel's scattered light comes from, within the mean radius of the profile, 2.5 d, with the mean
// mark of its objects; and the luminance of what came in nearer.
vec4 light_around(ViewLines lines, Facet here, out float near) {
    vec3 d = scattering_profile(here.key - 1u).d;
    float radius_px = 2.5 * max(d.r, max(d.g, d.b)) * pixels_per_mm(lines, here.depth_m);
    // A texel of level 0 is the mean of 2 x 2 px.
    float level = clamp(log2(max(radius_px, 1.0)), 0.0, kMostLevel - 1.0);
    vec2 place = 0.5 * gl_FragCoord.xy * light_means_size.zw;
    near = luminance(textureLod(light_means, place, max(level - 2.0, 0.0)).rgb);
    return textureLod(light_means, place, level);
}

// Whether `now` is `then` but for kLightChange.
bool alike(float now, float then) { return abs(now - then) <= kLightChange * max(now, then); }

// Whether light is what it was in the frame before, or only brighter or darker, `times` as bright; if not, the average is of
// no use. Where objects came or went, brighter may be what they are.
bool same_light(vec4 now, vec4 then, float near_now, float near_then, out vec3 times) {
    times = vec3(1.0);
    float far_now = luminance(now.rgb), far_then = luminance(then.rgb);
    if (alike(far_now, far_then)) return true;
    times = now.rgb / max(then.rgb, now.rgb / kMostChange + 1e-20);
    return abs(now.a - then.a) < 1e-3 && alike(near_now * far_then, near_then * far_now);
}

// What a pixel that scatters comes to after this frame.
struct Guided {
    Gathered sums;
    float frames;   // how many they are of
    vec4 lit;
    float lit_near;
};

// `now`: of the frame. q: where the pixel was, if was_seen, in the frame before. Sums are averaged apart: a ratio of few samples
// is off in the mean, that of the averages less.
Guided guided_light(ViewLines lines, Gathered now, Facet here, ivec2 q, bool was_seen) {
    vec3 times;
    float near_now;
    vec4 lit_now = light_around(lines, here, near_now);
    vec4 light = texelFetch(guided_prev, q, 0), share = texelFetch(guided_share_prev, q, 0);
    vec3 whole = texelFetch(guided_whole_prev, q, 0).rgb;
    if (!was_seen || light.a == 0.0 || !same_light(lit_now, texelFetch(lit_prev, q, 0), near_now, share.a, times))
        return Guided(now, 1.0, lit_now, near_now);
    // Frames count alike until the newest would count less than its weight.
    float weight = max(1.0 / (light.a + 1.0), param.guiding_weight);
    Gathered sums = Gathered(mix(light.rgb * times, now.light, weight), mix(share.rgb, now.share, weight), mix(whole, now.whole, weight));
    return Guided(sums, 1.0 / weight, lit_now, near_now);
}

void keep_average(Guided now) {
    out_guided = vec4(now.sums.light, now.frames);
    out_guided_share = vec4(now.sums.share, now.lit_near);
    out_guided_whole = vec4(now.sums.whole, 0.0);
    out_lit = now.lit;
}
