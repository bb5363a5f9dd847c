#version 450 core
#include <pass>
#include <hash.glsl>
#include "key.glsl"
#include "mixed.glsl"
#include "surfel.glsl"
#include "layers.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

const float kHalf = 0.51;          // of a pixel; more than half, against gaps by rounding
const float kOneSurfacePx = 1.0;   // per px: neighbours that lens or shutter move further apart are of two surfaces
// Of a picture alone, an estimate fills what no captured pixel reaches. With layers, what is captured may lie far behind a hole.
#ifdef HAS_SECOND
const uint kEstimateAfter = 0u;
#else
const uint kEstimateAfter = kEstimate >> 20u;
#endif
const uint kEstimateBehind = 40u;  // levels of depth: a captured surface of about its depth comes first
const int kMostPx = 3;             // that one shading sample covers along a row or a column

// By how much lens (per unit of its point) and shutter (per exposure) move neighbours in a row and a column apart, px.
struct Stretch {
    vec2 by_coc, by_path;
};

float lesser(float a, float b) { return abs(a) < abs(b) ? a : b; }

Stretch stretch_at(int layer, ivec2 p, Surfel own, float at_infinity_px) {
    Stretch result = Stretch(vec2(0.0), vec2(0.0));
    ivec2 last = frame.size - 1;
    for (int axis = 0; axis < 2; ++axis) {
        ivec2 to = ivec2(1 - axis, axis);
        Surfel before = surfel_at(layer, max(p - to, ivec2(0)), at_infinity_px), after = surfel_at(layer, min(p + to, last), at_infinity_px);
        float coc_apart = lesser(own.coc_px - before.coc_px, after.coc_px - own.coc_px);
        float path_apart = lesser((own.path - before.path)[axis], (after.path - own.path)[axis]);
        if (abs(coc_apart) < kOneSurfacePx) result.by_coc[axis] = coc_apart;
        if (abs(path_apart) < kOneSurfacePx) result.by_path[axis] = path_apart;
    }
    return result;
}

// The samples that a surface of a share of the pixel gets: others for each pixel, evenly spread.
struct Cover {
    float share, first;
};

const Cover kAll = Cover(2.0, 0.0);

bool is_covered(Cover cover, int s) { return fract(cover.first + float(s) * 0.6180339887) < cover.share; }

// The shading sample of the pixel `from`, at `p`.
void splat(ivec2 p, ivec2 from, int layer, Surfel surfel, Stretch stretch, Cover cover) {
    uint level = level_of(surfel.depth_m, texelFetch(range, ivec2(0), 0).rg);
#ifdef HAS_HIDDEN_AT
    if (layer == kEstimatedLayer) level = min(level + kEstimateBehind, 2047u) | kEstimateAfter;
#endif
    for (int s = BAND * kBandSamples; s < min(param.samples, (BAND + 1) * kBandSamples); ++s) {
        if (!is_covered(cover, s)) continue;
        vec3 point = texelFetch(points, ivec2(s, 0), 0).xyz;
        vec2 to = vec2(p) + surfel.coc_px * point.xy + way_px(surfel.path, point.z);
        vec2 half_px = kHalf + 0.5 * max(stretch.by_coc * point.xy + stretch.by_path * point.z, vec2(0.0));
        ivec2 first = max(ivec2(ceil(to - half_px)), max(from - kFurthestPx, ivec2(0)));
        ivec2 last = min(min(ivec2(floor(to + half_px)), first + kMostPx - 1), min(from + kFurthestPx, frame.size - 1));
        for (int y = first.y; y <= last.y; ++y)
            for (int x = first.x; x <= last.x; ++x)
                imageAtomicMin(keys, ivec3(x, y, s - BAND * kBandSamples), key_of(level, layer, ivec2(x, y) - from));
    }
}

void splat_layer(ivec2 p, int layer, float at_infinity_px) {
    Surfel surfel = surfel_at(layer, p, at_infinity_px);
    if (surfel.share < kNothing) return;
    Cover cover = surfel.share > kWhole ? kAll : Cover(surfel.share, unit_float(pcg3d16(uvec3(p, layer)).x << 16u));
    splat(p, p, layer, surfel, stretch_at(layer, p, surfel, at_infinity_px), cover);
}

#ifndef HAS_SECOND
// A pixel of two surfaces is a shading sample of both: the nearer one gets the visibility samples of its share.
void splat_picture(ivec2 p, float at_infinity_px) {
    Surfel own = surfel_at(0, p, at_infinity_px);
    Stretch stretch = stretch_at(0, p, own, at_infinity_px);
    Mixture mixture = unpack_mixture(texelFetch(mixed, p, 0).r);
    float first = unit_float(pcg3d16(uvec3(p, 0u)).x << 16u);
    ivec2 other = p + mixture.across;
    Surfel across = surfel_at(0, other, at_infinity_px);
    bool is_behind = across.depth_m < own.depth_m;
    splat(p, p, 0, own, stretch, mixture.share == 0.0 || is_behind ? kAll : Cover(1.0 - mixture.share, first));
    if (mixture.share > 0.0) splat(p, other, 0, across, Stretch(vec2(0.0), vec2(0.0)), is_behind ? Cover(mixture.share, first) : kAll);
}
#endif

void main() {
    ivec2 p = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(p, frame.size)) || param.samples <= BAND * kBandSamples) return;
#ifdef HAS_SENDS
    vec2 sent = texelFetch(sends, p / 16, 0).rg;
    if (sent.g == 0.0) return;
#else
    const vec2 sent = vec2(1.0);
#endif
    float at_infinity_px = lens_at_infinity_px();
#ifdef HAS_SECOND
    if (sent.r > 0.0) splat_layer(p, 0, at_infinity_px);
#else
    if (sent.r > 0.0) splat_picture(p, at_infinity_px);
#endif
#ifdef HAS_LAYER_1
    splat_layer(p, 1, at_infinity_px);
#endif
#ifdef HAS_LAYER_2
    splat_layer(p, 2, at_infinity_px);
#endif
#ifdef HAS_LAYER_3
    splat_layer(p, 3, at_infinity_px);
#endif
#ifdef HAS_HIDDEN_AT
    uvec4 at = texelFetch(hidden_at, p, 0);
    if (at.w != 0u) {
        float depth_m = uintBitsToFloat(at.z);
        vec4 path = vec4(unpackHalf2x16(at.x), unpackHalf2x16(at.y));
        splat(p, p, kEstimatedLayer, Surfel(depth_m, coc_of(depth_m, at_infinity_px), path, 1.0), Stretch(vec2(0.0), vec2(0.0)), kAll);
    }
#endif
}
