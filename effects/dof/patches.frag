#version 450 core
#include <pass>
#include <lens/highlight.glsl>
#include "taps.glsl"
#include "known.glsl"

// What lies behind a surface near its silhouette, continued from both ends of chords through the pixel. Chords whose ends are
// alike and close count most: they run along the edges of what is hidden. This is guessed, and shows through a blur only. Where the
// capture has a second layer, that is the patch.
const int kChords = 12;
const float kLeastRadiusPx = 2.0;   // of a surface that lets anything through
const float kOneSurface = 2.0;      // difference of CoC radii of ends on one surface, px
const float kOutshines = 8.0;       // light of one end that does not continue behind the other
const float kUnlike = 0.02;         // relative difference of ends that halves a chord's weight

struct End {
    Light light;
    float distance_px;  // negative where nothing was found
};

// Walks away from a pixel to the first surface that lies behind its own. A step in CoC that continues a slope is not a silhouette.
End walk(vec2 center, Light own, vec2 direction, float reach_px) {
    float coc = own.coc, slope = 0.0, at_px = 1.0;
    while (at_px <= reach_px) {
        int level = at_px < 8.0 ? 0 : at_px < 16.0 ? 1 : at_px < 32.0 ? 2 : 3;
        float stride_px = float(1 << level);
        vec2 q = center + at_px * direction;
        if (any(lessThan(q, vec2(0.0))) || any(greaterThanEqual(q, vec2(frame.size)))) break;
        Light tap = tap_light(ivec2(q) >> level, level);
        if (tap.coc - (coc + max(slope, 0.0) * stride_px) > kClear && tap.coc > own.coc + kClear) return End(tap, at_px);
        if (tap.coc > own.coc - kClear) {  // not something in front of both
            slope = clamp((tap.coc - coc) / stride_px, -1.0, 1.0);
            coc = tap.coc;
        }
        at_px += stride_px;
    }
    return End(own, -1.0);
}

struct Chord {
    Light light;   // where it passes the pixel
    float weight;  // 0 where it has no end
};

Chord chord_through(vec2 center, Light own, vec2 direction, float reach_px) {
    End a = walk(center, own, direction, reach_px), b = walk(center, own, -direction, reach_px);
    bool has_a = a.distance_px > 0.0, has_b = b.distance_px > 0.0;
    if (!has_a && !has_b) return Chord(own, 0.0);
    if (!has_a || !has_b || abs(a.light.coc - b.light.coc) > kOneSurface) {
        End end = !has_b || has_a && a.distance_px < b.distance_px ? a : b;
        float length_px = 2.0 * end.distance_px + reach_px;
        return Chord(end.light, 1.0 / (length_px * length_px));
    }
    float length_px = a.distance_px + b.distance_px, part = a.distance_px / length_px;
    float amount_a = amount(a.light.color.rgb), amount_b = amount(b.light.color.rgb);
    if (amount_a > kOutshines * amount_b) part = 1.0;
    if (amount_b > kOutshines * amount_a) part = 0.0;
    float unlike = amount(abs(a.light.color.rgb - b.light.color.rgb)) / max(amount_a + amount_b, 1e-3);
    return Chord(Light(mix(a.light.color, b.light.color, part), mix(a.light.coc, b.light.coc, part)),
                 1.0 / (length_px * length_px * (kUnlike + unlike)));
}

void main() {
    ivec2 p = ivec2(gl_FragCoord.xy);
    Light own = tap_light(p, 0);
    out_patches = kNoPatch;
    float radius_px = abs(own.coc);
    if (radius_px < kLeastRadiusPx || texelFetch(around, p / kTile, 0).w <= own.coc + kClear) return;

#ifdef KNOWS_BEHIND
    if (is_known(p)) {
        out_patches = pack_light(known_behind(p));
        return;
    }
#endif
    Chord chords[kChords];
    int best = 0;
    for (int i = 0; i < kChords; ++i) {
        float angle = 3.14159265 * float(i) / float(kChords);
        chords[i] = chord_through(vec2(p) + 0.5, own, vec2(cos(angle), sin(angle)), radius_px + 1.5);
        if (chords[i].weight > chords[best].weight) best = i;
    }
    if (chords[best].weight == 0.0) return;
    float darkest = 1e30;
    for (int i = 0; i < kChords; ++i) {
        if (abs(chords[i].light.coc - chords[best].light.coc) > kOneSurface) chords[i].weight = 0.0;
        if (chords[i].weight > 0.0) darkest = min(darkest, max(amount(chords[i].light.color.rgb), 0.0));
    }
    vec4 color = vec4(0.0);
    float coc = 0.0, sum = 0.0;
    for (int i = 0; i < kChords; ++i) {
        float outshines = max(amount(chords[i].light.color.rgb) / (kOutshines * darkest + 1e-6), 1.0);
        float weight = chords[i].weight * chords[i].weight / (outshines * outshines * outshines);
        color += weight * chords[i].light.color;
        coc += weight * chords[i].light.coc;
        sum += weight;
    }
    if (sum > 0.0) out_patches = pack_light(Light(color / sum, coc / sum));
}
