// The average over frames within the step.
#include <scattering/facet.glsl>
#include <scattering/filled.glsl>
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
    float level = clamp(log2(max(2.0 * radius_px, 1.0)), 0.0, kMostLevel);
    vec2 place = gl_FragCoord.xy * light_size.zw;
    near = luminance(textureLod(light, place, max(level - 2.0, 0.0)).rgb);
    return textureLod(light, place, level);
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
    vec4 light;   // the texture guided
    vec3 share;
    vec4 lit;
    float lit_near;
};

// `now` is the frame's light, filled by its share. Light before that and shares are averaged apart: of a share that samples
// made noisy, filled() of each frame would be brighter in the mean. q: where the pixel was, if was_seen, in the frame before.
Guided guided_light(ViewLines lines, vec3 now, vec3 share_now, Facet here, ivec2 q, bool was_seen) {
    vec3 times;
    float near_now;
    vec4 lit_now = light_around(lines, here, near_now);
    vec4 past = texelFetch(guided_prev, q, 0), past_share = texelFetch(guided_share_prev, q, 0);
    bool known = was_seen && past.a > 0.0 && same_light(lit_now, texelFetch(lit_prev, q, 0), near_now, past_share.a, times);
    // Frames count alike until the newest would count less than its weight.
    float frames = known ? past.a + 1.0 : 1.0;
    float weight = max(1.0 / frames, param.guiding_weight);
    vec3 sum = now * filling(share_now);
    vec3 light = known ? mix(past.rgb * times, sum, weight) : sum;
    vec3 share = known ? mix(past_share.rgb, share_now, weight) : share_now;
    return Guided(vec4(light, 1.0 / weight), share, lit_now, near_now);
}

void keep_average(Guided now) {
    out_guided = now.light;
    out_guided_share = vec4(now.share, now.lit_near);
    out_lit = now.lit;
}
