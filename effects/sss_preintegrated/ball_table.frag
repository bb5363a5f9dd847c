#version 450 core
#include <pass>
#include <scattering/by_index.glsl>
#include "tables.glsl"

// How much more light than N.L a place on a ball gets from scattering, under one light from far away (Penner and Borshukov
// 2011). The difference, so that a plane keeps its light to the bit.

const float kPi = 3.14159265358979;
const int kSamples = 160;

#if INTEGRAL == INTEGRAL_SPHERE
// Mean of max(N.L, 0) over the circle at an angle x around a place on the ball, where N.L is `cosine`.
float mean_on_circle(float cosine, float x) {
    float sine = sqrt(max(1.0 - cosine * cosine, 0.0));
    float middle = cosine * cos(x), swing = sine * sin(x);
    if (middle >= swing) return middle;
    if (middle <= -swing) return 0.0;
    float lit = acos(clamp(-middle / swing, -1.0, 1.0));
    return (middle * lit + swing * sin(lit)) / kPi;
}

// Over the surface: the area at a distance r through the ball, 2 pi r dr, is the plane's.
vec3 scattered(ScatteringProfileRow row, float cosine, float radius, int samples) {
    float end = min(row.reach, 2.0 * radius);
    vec3 sum = vec3(0.0), all = vec3(1e-30);
    for (int i = 0; i < samples; ++i) {
        // Closer where the profile is steep.
        float at = (float(i) + 0.5) / float(samples), r = at * at * end;
        vec3 share = scattering_profile_radial(row, r) * at;
        sum += share * mean_on_circle(cosine, 2.0 * asin(min(r / (2.0 * radius), 1.0)));
        all += share;
    }
    return sum / all;
}
#else
// R(r) by the profile's Gaussians: that of others may have no finite value at 0, and no integral along a line.
vec3 density(ScatteringProfileRow row, float r) {
    vec3 sum = vec3(0.0);
    for (int k = 0; k < SCATTERING_PROFILE_GAUSSIANS; ++k) {
        vec3 variance = max(scattering_profile_variance(row, k), 1e-12);
        sum += scattering_profile_weight(row, k) / variance * exp(-0.5 * r * r / variance);
    }
    return sum;
}

// Around the great circle through the light, as published.
vec3 scattered(ScatteringProfileRow row, float cosine, float radius, int samples) {
    float angle = acos(clamp(cosine, -1.0, 1.0));
    float end = row.reach < 2.0 * radius ? 2.0 * asin(row.reach / (2.0 * radius)) : kPi;
    vec3 sum = vec3(0.0), all = vec3(1e-30);
    for (int i = 0; i < samples; ++i) {
        float at = (float(i) + 0.5) / float(samples), x = at * at * at * end;
        vec3 share = density(row, 2.0 * radius * sin(0.5 * x)) * (at * at);
        sum += share * 0.5 * (max(cos(angle + x), 0.0) + max(cos(angle - x), 0.0));
        all += share;
    }
    return sum / all;
}
#endif

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    int profile = at.y / kBallLines, line = at.y % kBallLines;
    float cosine = ball_cosine(at.x), curvature = ball_curvature(line);
    ScatteringProfileRow row = profile_at(profile);
    // Loops that nobody needs do not turn.
    int samples = profile < profile_count() && line > 0 ? kSamples : 0;
    vec3 more = scattered(row, cosine, max(row.d.r, max(row.d.g, row.d.b)) / max(curvature, 1e-6), samples) - max(cosine, 0.0);
    out_ball_table = samples == 0 ? vec4(0.0) : vec4((1.0 - row.direct) * more, 1.0);
}
