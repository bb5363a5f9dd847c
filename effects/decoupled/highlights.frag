#version 450 core
#include <pass>
#include <aperture.glsl>
#include "cells.glsl"
#include "key.glsl"
#include "surfel.glsl"

flat in ivec2 source;

// The sample of the first band that is nearest to a point of the lens at a time, 0 to kTimes.
int sample_near(vec2 point, int time) {
    ivec2 cell = clamp(ivec2(floor((0.5 * point + 0.5) * float(kCells))), ivec2(0), ivec2(kCells - 1));
    return int(texelFetch(cells, cell + ivec2(0, kCells * time), 0).r);
}

// Whether nothing in front hides what the sample sees here.
bool is_seen(ivec2 p, int s, uint level) {
    uint key = imageLoad(keys, ivec3(p, s)).r;
    return key >= kEstimate || level_in(key) >= level;
}

// A highlight's light is spread over the aperture's outline exactly, and each place of it seen or not as by the nearest visibility
// sample.
void main() {
    ivec2 p = ivec2(gl_FragCoord.xy);
#ifdef HAS_MEET
    if (texelFetch(meet, p / 16, 0).r == 0.0) discard;
#endif
    Aperture aperture = make_aperture(param.blades, param.curvature, radians(param.rotation));
    float coc_px = texelFetch(coc, source, 0).r, radius_px = abs(coc_px), part = 0.0;
    vec4 path = path_at(source);
    uint level = level_of(texelFetch(depth, source, 0).r, texelFetch(range, ivec2(0), 0).rg);
#ifdef HAS_VELOCITY
    bool moves = texelFetch(reach, p / 16, 0).r > radius_px + 0.5;
#else
    bool moves = false;
#endif
    int times = moves ? kTimes : 1;
    for (int i = 0; i < times; ++i) {
        float t = moves ? kOpens + (float(i) + 0.5) / float(times) : 0.0;
        vec2 offset = vec2(p - source) - way_px(path, t), point = offset / coc_px;
        float covers = clamp((radius_px - radius_px * aperture_gauge(aperture, point)) * aperture.inradius + 0.5, 0.0, 1.0);
        if (covers > 0.0 && is_seen(p, sample_near(point, moves ? i : kTimes), level)) part += covers;
    }
    part /= float(times) * max(aperture.area * radius_px * radius_px, 1.0);
#ifdef HAS_MEET
    float reaches = part > 0.0 ? 1.0 : 0.0;
#else
    const float reaches = 0.0;
#endif
    out_highlights = vec4(part * texelFetch(highlight, source, 0).rgb, reaches);
}
