#version 450 core
#include <pass>
#include "order.glsl"
#include "surfel.glsl"
#include "layers.glsl"

// What lies behind a surface near its silhouette, where lens or shutter may show it: continued from both ends of chords through the
// pixel. Chords whose ends are alike and close count most: they run along the edges of what is hidden.
const int kTile = 16;
const int kChords = 12;
const float kFurthestPx = 96.0;
const float kThinPx = 4.0;         // CoC radius of what may be thinner than its blur
const float kOneSurfacePx = 2.0;   // of both ends
const float kUnlike = 0.02;        // relative difference of ends that halves a chord's weight
const float kOutshines = 8.0;      // light of one end that does not continue behind the other

float order_at(ivec2 p) { return texelFetch(order, p, 0).r; }
float amount(vec3 rgb) { return rgb.r + rgb.g + rgb.b; }

struct End {
    ivec2 at;
    float distance_px;  // negative: there is none
};

// At the rim of what curves away, a surface ends some px further on.
ivec2 past_rim(ivec2 q, vec2 direction) {
    float edge = order_at(q);
    for (int i = 1; i <= 3; ++i) {
        ivec2 further = ivec2(floor(vec2(q) + float(i) * direction + 0.5));
        if (any(lessThan(further, ivec2(0))) || any(greaterThanEqual(further, frame.size))) return q;
        if (order_at(further) > edge + kClearPx) return further;
    }
    return q;
}

// Walks away from a pixel to the first surface that lies behind its own. A step that continues a slope is not a silhouette.
End walk(ivec2 p, float own, vec2 direction, float furthest_px) {
    float last = own, slope = 0.0, at_px = 1.0;
    while (at_px <= furthest_px) {
        float stride_px = at_px < 16.0 ? 1.0 : at_px < 32.0 ? 2.0 : 4.0;
        ivec2 q = ivec2(floor(vec2(p) + at_px * direction + 0.5));
        if (any(lessThan(q, ivec2(0))) || any(greaterThanEqual(q, frame.size))) break;
        float tap = order_at(q);
        if (tap - (last + max(slope, 0.0) * stride_px) > kClearPx && tap > own + kClearPx) return End(past_rim(q, direction), at_px);
        if (tap > own - kClearPx) {  // not something in front of both
            slope = clamp((tap - last) / stride_px, -1.0, 1.0);
            last = tap;
        }
        at_px += stride_px;
    }
    return End(p, -1.0);
}

struct Chord {
    vec4 light, path;
    float depth_m, order, weight;
};

const Chord kNoChord = Chord(vec4(0.0), vec4(0.0), 0.0, 0.0, 0.0);

Chord from_end(End end, float weight) {
    return Chord(texelFetch(light, end.at, 0), path_at(end.at), texelFetch(depth, end.at, 0).r, order_at(end.at), weight);
}

// `is_thin`: only chords whose ends both lie within reach of each other.
Chord chord_through(ivec2 p, float own, vec2 direction, float furthest_px, bool is_thin) {
    End a = walk(p, own, direction, furthest_px), b = walk(p, own, -direction, furthest_px);
    bool has_a = a.distance_px > 0.0, has_b = b.distance_px > 0.0;
    bool is_short = has_a && has_b && a.distance_px + b.distance_px <= furthest_px;
    if (!has_a && !has_b || is_thin && !is_short) return kNoChord;
    Chord of_a = from_end(a, 1.0), of_b = from_end(b, 1.0);
    if (!has_a || !has_b || abs(of_a.order - of_b.order) > kOneSurfacePx) {
        bool takes_a = !has_b || has_a && a.distance_px < b.distance_px;
        float length_px = 2.0 * (takes_a ? a.distance_px : b.distance_px) + furthest_px;
        Chord one = takes_a ? of_a : of_b;
        one.weight = 1.0 / (length_px * length_px);
        return one;
    }
    float length_px = a.distance_px + b.distance_px, part = a.distance_px / length_px, way = part;
    float amount_a = amount(of_a.light.rgb), amount_b = amount(of_b.light.rgb);
    if (amount_a > kOutshines * amount_b) part = 1.0;
    if (amount_b > kOutshines * amount_a) part = 0.0;
    float unlike = amount(abs(of_a.light.rgb - of_b.light.rgb)) / max(amount_a + amount_b, 1e-3);
    float depth_m = way < 0.5 ? of_a.depth_m : of_b.depth_m;
    if (!isinf(of_a.depth_m) && !isinf(of_b.depth_m)) depth_m = mix(of_a.depth_m, of_b.depth_m, way);
    return Chord(mix(of_a.light, of_b.light, part), mix(of_a.path, of_b.path, way), depth_m, mix(of_a.order, of_b.order, way),
                 1.0 / (length_px * length_px * (kUnlike + unlike)));
}

// What lies behind a surface at the pixel: the mean of all chords to one surface; weight 0 where there is none.
Chord behind(ivec2 p, float own, float furthest_px, bool is_thin) {
    Chord chords[kChords];
    int best = 0;
    for (int i = 0; i < kChords; ++i) {
        float angle = 3.14159265 * float(i) / float(kChords);
        chords[i] = chord_through(p, own, vec2(cos(angle), sin(angle)), furthest_px, is_thin);
        if (chords[i].weight > chords[best].weight) best = i;
    }
    Chord mean = kNoChord;
    if (chords[best].weight == 0.0) return mean;
    float nearness = 0.0;
    for (int i = 0; i < kChords; ++i) {
        if (chords[i].weight == 0.0 || abs(chords[i].order - chords[best].order) > kOneSurfacePx) continue;
        float weight = chords[i].weight * chords[i].weight;
        mean.light += weight * chords[i].light;
        mean.path += weight * chords[i].path;
        mean.order += weight * chords[i].order;
        nearness += weight / chords[i].depth_m;
        mean.weight += weight;
    }
    mean.light /= mean.weight;
    mean.path /= mean.weight;
    mean.order /= mean.weight;
    mean.depth_m = mean.weight / nearness;
    return mean;
}

// How far behind lies the last surface that the capture has of a pixel.
float last_order(ivec2 p, float at_infinity_px) {
    float last = order_at(p);
#ifdef HAS_LAYER_1
    for (int layer = 1; layer <= 2; ++layer) {
        Surfel surfel = surfel_at(layer, p, at_infinity_px);
        if (surfel.share > 0.5) last = max(last, surfel.coc_px + kPxPerOctave * min(log2(surfel.depth_m), kInfinityOctaves));
    }
#endif
    return last;
}

void main() {
    ivec2 p = ivec2(gl_FragCoord.xy);
    out_hidden = vec4(0.0);
    out_hidden_at = uvec4(0u);
    float around_px = texelFetch(reach, p / kTile, 0).r;
    float furthest_px = min(reach_px(texelFetch(coc, p, 0).r, path_at(p)) + around_px, kFurthestPx) + 1.5;
    float at_infinity_px = lens_at_infinity_px();
    float last = last_order(p, at_infinity_px);
    if (texelFetch(behind_order, p / kTile, 0).r <= last + kClearPx) return;
    Chord found = behind(p, last, furthest_px, false);
    if (found.weight == 0.0) return;
    // What is thinner than its blur shows what is behind it in turn.
    for (int i = 0; i < 2; ++i) {
        float coc_px = coc_of(found.depth_m, at_infinity_px);
        if (coc_px > -kThinPx) break;
        Chord further = behind(p, found.order, -coc_px, true);
        if (further.weight == 0.0) break;
        found = further;
    }
    out_hidden = found.light;
    out_hidden_at = uvec4(packHalf2x16(found.path.xy), packHalf2x16(found.path.zw), floatBitsToUint(found.depth_m), 1u);
}
