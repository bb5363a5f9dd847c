#version 450 core
#include <pass>
#include <erf.glsl>

struct Place {
    vec3 position;  // mm
    uint key;       // 0 where nothing scatters
};

Place place_of(ivec2 p) {
    uvec4 texel = texelFetch(place, p, 0);
    return Place(uintBitsToFloat(texel.xyz), texel.w);
}

// Taps lie this many standard deviations of what the light is already blurred by apart: of finer detail less
// than exp(-2 pi^2 / 1.5^2) = 1.6e-4 is left. With 31 taps edges are off by 0.001 so; each blurred from the light
// that came in, by 0.06 and in twice the time.
const float kSpacing = 1.5;
const float kReach = 3.0;  // standard deviations

// A tap stands for the surface from the one before on: where that is steeper than in the middle, for more. Not for what
// lies behind a step in depth: with 2 a head comes nearest to sss_exact.
const float kMostLength = 2.0;

// Millimetres from a pixel to its neighbour; the nearer one's, for beyond an edge of the surface it is far.
float spacing_at(ivec2 p, ivec2 along, Place here) {
    float spacing = 1e30;
    for (int side = -1; side <= 1; side += 2) {
        ivec2 q_free = p + side * along, q = clamp(q_free, ivec2(0), frame.size - 1);
        Place there = place_of(q);
        if (q == q_free && there.key == here.key) spacing = min(spacing, distance(here.position, there.position));
    }
    return max(spacing, 1e-6);
}

struct Taps {
    int step_px;
    int count;      // on each side
    float spacing;  // from tap to tap, mm
};

Taps taps_for(vec3 growth, float least, float spacing) {
    float widest = sqrt(max(growth.r, max(growth.g, growth.b)));
    float most = float(param.samples / 2);
    float step_px = max(floor(kSpacing * least / spacing), 1.0);
    step_px = min(max(step_px, ceil(kReach * widest / (most * spacing))), 16384.0);
    float count = min(ceil(kReach * widest / (step_px * spacing)), most);
    return widest > 0.0 && spacing < 1e29 ? Taps(int(step_px), int(count), step_px * spacing) : Taps(1, 0, spacing);
}

#if FIRST
// The light of square pixels at a pixel's middle: the part of the Gaussian within each.
vec3 growth_of(vec3 before, vec3 variance, Taps taps) { return variance; }
vec3 weight_of(vec3 growth, float r, float spacing, bool nearest) {
    vec3 scale = inversesqrt(2.0 * max(growth, 1e-20));
    return 0.5 * (erf_of((r + 0.5 * spacing) * scale) - erf_of(max(r - 0.5 * spacing, 0.0) * scale));
}
vec3 weight_of_own(vec3 growth, float spacing) {
    return erf_of(0.5 * spacing * inversesqrt(2.0 * max(growth, 1e-20)));
}
#else
// Variance of what a Gaussian makes of square pixels, of a variance of up to 0.6 px^2; above it is 1/12 px^2 more.
vec3 variance_of_squares(vec3 variance) {
    vec3 scale = inversesqrt(2.0 * max(variance, 1e-20)), sum = vec3(0.0);
    for (int i = 1; i <= 3; ++i)
        sum += float(i * i) * (erf_of((float(i) + 0.5) * scale) - erf_of((float(i) - 0.5) * scale));
    return mix(sum, variance + 1.0 / 12.0, greaterThan(variance, vec3(0.6)));
}
// What variance this blur adds, mm^2.
vec3 growth_of(vec3 before, vec3 variance, Taps taps) {
    vec3 per = vec3(1.0 / (taps.spacing * taps.spacing));
    vec3 of_squares = (variance_of_squares(variance * per) - variance_of_squares(before * per)) / per;
    return taps.step_px == 1 ? of_squares : variance - before;
}
// Of what is smooth already the Gaussian at each tap; one narrower than taps can show is three taps of its variance.
vec3 weight_of(vec3 growth, float r, float spacing, bool nearest) {
    vec3 shape = 0.5 * growth / (spacing * spacing);
    vec3 narrow = 0.5 * growth / max(r * r, 0.1 * spacing * spacing) / (1.0 - 2.0 * min(shape, 0.25));
    if (!nearest) narrow = vec3(0.0);
    return mix(exp(-r * r / (2.0 * max(growth, 1e-20))), narrow, lessThan(shape, vec3(0.25)));
}
vec3 weight_of_own(vec3 growth, float spacing) { return vec3(1.0); }
#endif

// The light, blurred from the variance `before` to `variance`, mm^2; by the least standard deviation that it has, mm.
vec3 blurred_at(ivec2 p, ivec2 along, Place here, vec3 before, vec3 variance, float least) {
    float pixel = spacing_at(p, along, here);
    Taps taps = taps_for(variance - before, least, pixel);
    vec3 growth = growth_of(before, variance, taps);
    vec3 share = weight_of_own(growth, taps.spacing), sum = share * texelFetch(SOURCE, p, 0).rgb;
    for (int side = -1; side <= 1; side += 2) {
        vec3 last = here.position;
        for (int i = 1; i <= taps.count; ++i) {
            ivec2 q_free = p + side * i * taps.step_px * along, q = clamp(q_free, ivec2(0), frame.size - 1);
            Place there = place_of(q);
            vec3 weight = weight_of(growth, distance(here.position, there.position), taps.spacing, i == 1);
            vec3 light = texelFetch(SOURCE, q, 0).rgb;
            if (q != q_free || there.key != here.key) continue;
            weight *= min(distance(last, there.position) / taps.spacing, kMostLength);
            last = there.position;
            sum += weight * light;
            share += weight;
        }
    }
    return sum / max(share, 1e-20);
}

void main() {
    ivec2 p = ivec2(gl_FragCoord.xy);
#if FIRST
    int turn = ADDS;
#else
    int turn = 2 + pass.index;
#endif
    Place here = place_of(p);
    vec3 light = texelFetch(SOURCE, p, 0).rgb;
    vec3 weight = vec3(0.0);
    if (here.key != 0u) {
        int row = scattering_profile(here.key - 1u).index;
        vec4 wider = texelFetch(gaussians, ivec2(turn / 2, row), 0);
        vec3 narrower = turn < 2 ? vec3(0.0) : texelFetch(gaussians, ivec2(turn / 2 - 1, row), 0).rgb;
        weight = turn % 2 == 1 ? texelFetch(gaussians, ivec2(8 + turn / 2, row), 0).rgb : vec3(0.0);
        vec3 after = blurred_at(p, turn % 2 == 0 ? ivec2(1, 0) : ivec2(0, 1), here, narrower, wider.rgb, wider.a);
        light = mix(light, after, greaterThan(wider.rgb, narrower));
    }
    out_blurred = vec4(light, 1.0);
#if ADDS && FIRST
    out_sum = vec4(weight * light, 1.0);
#elif ADDS
    out_sum = texelFetch(sum, p, 0) + vec4(weight * light, 0.0);
#endif
}
