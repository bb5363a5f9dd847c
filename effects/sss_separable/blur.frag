#version 450 core
#include <pass>
#include <scattering/lines.glsl>
#include <scattering/profile.glsl>
#include "packing.glsl"
#if !ALONG_ROWS
#include <scattering/result.glsl>
#endif

#if ALONG_ROWS
const ivec2 kStep = ivec2(1, 0);
const vec3 kAlong = vec3(1.0, 0.0, 0.0);  // in view space
#else
const ivec2 kStep = ivec2(0, 1);
const vec3 kAlong = vec3(0.0, -1.0, 0.0);
#endif

// The surface's plane through the pixel's middle, cut along the row or column. A step along it that goes t across the
// view goes slope * t in depth and stretch * t in all.
struct Cut {
    float depth_mm;
    float slope;
    float stretch;
    vec3 line;
};

Cut cut_at(ViewLines lines, ivec2 p, float depth_m) {
    vec2 slopes = unpackHalf2x16(texelFetch(facet, p, 0).g);
    float slope = ALONG_ROWS == 1 ? slopes.x : slopes.y;
    vec3 line = view_line(lines, vec2(p) + 0.5);
    return Cut(param.world_unit * depth_m, slope, length(slope * line + kAlong), line);
}

// Pixels to where the cut is x mm away.
float pixels_to(ViewLines lines, Cut cut, float x) {
    float across = x / cut.stretch;
    return across / (lines.slope.x * max(cut.depth_mm + across * cut.slope, 0.05 * cut.depth_mm));
}

// How much farther away than on the cut what is seen `pixels` away lies, mm.
float detour(ViewLines lines, Cut cut, float pixels, float depth_mm) {
    float angle = pixels * lines.slope.x;
    float across = angle * cut.depth_mm / max(1.0 - angle * cut.slope, 0.05);
    return length(depth_mm * (cut.line + angle * kAlong) - cut.depth_mm * cut.line) - abs(across) * cut.stretch;
}

void main() {
    ivec2 p = ivec2(gl_FragCoord.xy);
    ViewLines lines = view_lines();
    Lit here = unpack(texelFetch(SOURCE, p, 0));
    vec3 blurred = here.light;
    if (here.key != 0u) {
        ScatteringProfileRow profile = scattering_profile(here.key - 1u);
        Cut cut = cut_at(lines, p, here.depth_m);
        vec3 share = texelFetch(half_kernel, ivec2(0, profile.index), 0).rgb, sum = share * here.light;
        for (int i = 1; i <= param.samples / 2; ++i) {
            vec4 tap = texelFetch(half_kernel, ivec2(i, profile.index), 0);
            for (int side = -1; side <= 1; side += 2) {
                // The nearest pixel, whose light is that of its square. Mixed from two, edges at 25 taps would be off
                // by 0.020 instead of 0.024, for twice the fetches.
                float pixels = clamp(floor(pixels_to(lines, cut, float(side) * tap.a) + 0.5), -32768.0, 32768.0);
                ivec2 q_free = p + int(pixels) * kStep, q = clamp(q_free, ivec2(0), frame.size - 1);
                Lit there = unpack(texelFetch(SOURCE, q, 0));
                float farther = detour(lines, cut, pixels, param.world_unit * there.depth_m);
                vec3 weight = tap.rgb * exp(-max(farther, 0.0) / (3.0 * profile.d));
                if (q != q_free || there.key != here.key) continue;
                sum += weight * there.light;
                share += weight;
            }
        }
#if MISSING == MISSING_OWN
        blurred = sum + (1.0 - share) * here.light;
#else
        blurred = sum / share;
#endif
    }
#if ALONG_ROWS
    out_rows = pack(Lit(blurred, here.depth_m, here.key));
#else
    out_irradiance = scattered_result(p, blurred);
#endif
}
