#include <lens/highlight.glsl>
#include "loads.glsl"
#include <lens/neighbours.glsl>

// What lies behind a surface near its silhouette, continued from both ends of chords through the pixel. Chords whose ends are
// alike and close count most: they run along the edges of what is hidden. This is guessed, and shows through a blur only. Where the
// capture has a second layer, that is the patch.
#ifdef GUESSES
const int kChords = 8;  // for the mean of neighbours
#else
const int kChords = 12;
#endif
const float kOneSurface = 2.0;      // difference of CoC radii of ends on one surface, px
const float kOnePathPx = 0.5;       // and of the pixel whose motion an end has
const float kOutshines = 8.0;       // light of one end that does not continue behind the other
const float kUnlike = 0.02;         // relative difference of ends that halves a chord's weight
const float kFinePx = 7.0;  // of a walk, by the pixel
const float kThinPx = 4.0;  // CoC radius of what may be thinner than its blur, and then shows what is behind it
const float kTrustPx = 8.0;  // times the square of the best chord's length, px: how far a neighbour's view may lie to be like it

// How far from a place within the picture a direction leads out of it, px.
float outside_from_px(vec2 center, vec2 direction) {
    vec2 edge = mix(vec2(0.0), vec2(frame.size), greaterThan(direction, vec2(0.0)));
    vec2 at_px = abs(edge - center) / max(abs(direction), vec2(1e-6));
    return min(at_px.x, at_px.y);
}

// A walk takes the pixels nearby, and further away texels of coarser levels.
int level_of(float at_px) { return at_px <= kFinePx || !has_coarse_levels() ? 0 : at_px < 16.0 ? 1 : at_px < 32.0 ? 2 : 3; }

struct Walk {
    float coc, slope;   // of the last tap that lay behind what is in front of both
    float distance_px;  // to the first surface that lies behind the pixel's own; negative until one is found
    bool is_over;
};

// A step in CoC that continues a slope is not a silhouette.
void step_on(inout Walk walk, float tap_coc, bool is_outside, float own_coc, float at_px, float stride_px) {
    bool is_found = !(walk.is_over || is_outside) && tap_coc - (walk.coc + max(walk.slope, 0.0) * stride_px) > kClear && tap_coc > own_coc + kClear;
    bool is_passed = tap_coc > own_coc - kClear;  // not something in front of both
    walk.slope = is_passed ? clamp((tap_coc - walk.coc) * (1.0 / stride_px), -1.0, 1.0) : walk.slope;
    walk.coc = is_passed ? tap_coc : walk.coc;
    walk.distance_px = is_found ? at_px : walk.distance_px;
    walk.is_over = walk.is_over || is_outside || is_found;
}

float coc_near(ivec2 p) { return as_half(texelFetch(lit_coc, p, 0).r); }
float coarse_coc_at(ivec2 texel, Grid grid) { return texelFetch(coarse_coc, clamp(texel, ivec2(0), grid.last) + grid.origin, 0).r; }

struct Walks { Walk a, b; };

// Both ways along a chord at once.
Walks walk_chord(vec2 center, float own_coc, vec2 direction, float reach_px) {
    Walk walk = Walk(own_coc, 0.0, -1.0, false);
    Walks walks = Walks(walk, walk);
    float outside_a_px = outside_from_px(center, direction), outside_b_px = outside_from_px(center, -direction);
    float fine_px = has_coarse_levels() ? min(reach_px, kFinePx) : reach_px, at_px = 1.0;
    do {
        vec2 a = center + at_px * direction, b = center - at_px * direction;
        step_on(walks.a, coc_near(ivec2(a)), at_px >= outside_a_px, own_coc, at_px, 1.0);
        step_on(walks.b, coc_near(ivec2(b)), at_px >= outside_b_px, own_coc, at_px, 1.0);
        at_px += 1.0;
    } while (at_px <= fine_px && !(walks.a.is_over && walks.b.is_over));
    if (at_px <= reach_px && !(walks.a.is_over && walks.b.is_over)) do {
        vec2 a = center + at_px * direction, b = center - at_px * direction;
        int level = level_of(at_px);
        float stride_px = float(1 << level);
        Grid grid = grid_of(level);
        step_on(walks.a, coarse_coc_at(ivec2(a) >> level, grid), at_px >= outside_a_px, own_coc, at_px, stride_px);
        step_on(walks.b, coarse_coc_at(ivec2(b) >> level, grid), at_px >= outside_b_px, own_coc, at_px, stride_px);
        at_px += stride_px;
    } while (at_px <= reach_px && !(walks.a.is_over && walks.b.is_over));
    return walks;
}

struct End {
    Light light;
#ifdef SEES_NEIGHBOURS
    vec4 path;
    float path_weight;  // 0 where it is not known
#endif
    float distance_px;  // negative where nothing was found
};

End end_at(vec2 center, vec2 direction, float distance_px) {
    int level = level_of(distance_px);
    vec2 q = center + max(distance_px, 0.0) * direction;
    ivec2 texel = ivec2(q) >> level;
    Light found = tap_level(texel, grid_of(level));
#ifdef SEES_NEIGHBOURS
    End end = End(found, vec4(0.0), 0.0, distance_px);
    ivec2 last = frame.size - 1;
    // A texel of a coarse level may show a surface whose pixels begin up to two of it further on.
    for (int i = 0; i <= 4 && end.path_weight == 0.0; ++i) {
        ivec2 p = clamp(ivec2(q + 0.5 * float(i << level) * direction), ivec2(0), last);
        if (abs(tap_light(p).coc - found.coc) > kOnePathPx) continue;
        end.path = path_at(p);
        end.path_weight = 1.0;
    }
    return end;
#else
    return End(found, distance_px);
#endif
}

struct Chord {
    Light light;   // where it passes the pixel
#ifdef SEES_NEIGHBOURS
    vec4 path;
    float path_weight;
#endif
    float weight;  // 0 where it has no end
};

Chord chord_of(Light light, End a, End b, float part, float weight) {
#ifdef SEES_NEIGHBOURS
    return Chord(light, mix(a.path, b.path, part), min(a.path_weight, b.path_weight), weight);
#else
    return Chord(light, weight);
#endif
}

// `is_thin`: only chords whose ends both lie within the reach.
Chord chord_through(vec2 center, Light own, vec2 direction, float reach_px, bool is_thin) {
    Walks walks = walk_chord(center, own.coc, direction, reach_px);
    End a = end_at(center, direction, walks.a.distance_px), b = end_at(center, -direction, walks.b.distance_px);
    bool has_a = a.distance_px > 0.0, has_b = b.distance_px > 0.0;
    if (!has_a && !has_b) return chord_of(own, a, a, 0.0, 0.0);
    if (is_thin && (!has_a || !has_b || a.distance_px + b.distance_px > reach_px)) return chord_of(own, a, a, 0.0, 0.0);
    if (!has_a || !has_b || abs(a.light.coc - b.light.coc) > kOneSurface) {
        End end = !has_b || has_a && a.distance_px < b.distance_px ? a : b;
        float length_px = 2.0 * end.distance_px + reach_px;
        return chord_of(end.light, end, end, 0.0, 1.0 / (length_px * length_px));
    }
    float length_px = a.distance_px + b.distance_px, part = a.distance_px / length_px;
    float way = part;
    float amount_a = amount(a.light.color.rgb), amount_b = amount(b.light.color.rgb);
    if (amount_a > kOutshines * amount_b) part = 1.0;
    if (amount_b > kOutshines * amount_a) part = 0.0;
    float unlike = amount(abs(a.light.color.rgb - b.light.color.rgb)) / max(amount_a + amount_b, 1e-3);
    return chord_of(Light(mix(a.light.color, b.light.color, part), mix(a.light.coc, b.light.coc, part)), a, b, way,
                    1.0 / (length_px * length_px * (kUnlike + unlike)));
}

struct Patch {
    Chord mean;  // of all chords to one surface
    float trust;  // in the best of them: one over the square of its length, px, if its ends are alike
    bool is_there;
};

// What lies behind `own`, a surface at the pixel.
Patch patch_behind(vec2 center, Light own, float reach_px, bool is_thin) {
    Chord chords[kChords];
    int best = 0;
    const float kTurn = 3.14159265 / float(kChords);
    const mat2 kTurned = mat2(cos(kTurn), sin(kTurn), -sin(kTurn), cos(kTurn));
    vec2 direction = vec2(1.0, 0.0);
    for (int i = 0; i < kChords; ++i, direction = kTurned * direction) {
        chords[i] = chord_through(center, own, direction, reach_px, is_thin);
        if (chords[i].weight > chords[best].weight) best = i;
    }
    if (chords[best].weight == 0.0) return Patch(chords[best], 0.0, false);
    float darkest = 1e30;
    for (int i = 0; i < kChords; ++i) {
        if (abs(chords[i].light.coc - chords[best].light.coc) > kOneSurface) chords[i].weight = 0.0;
        if (chords[i].weight > 0.0) darkest = min(darkest, max(amount(chords[i].light.color.rgb), 0.0));
    }
    Chord mean = chords[best];
    float trust = kUnlike * chords[best].weight;
    mean.light = Light(vec4(0.0), 0.0);
    mean.weight = 0.0;
#ifdef SEES_NEIGHBOURS
    mean.path = vec4(0.0);
    mean.path_weight = 0.0;
#endif
    for (int i = 0; i < kChords; ++i) {
        float outshines = max(amount(chords[i].light.color.rgb) / (kOutshines * darkest + 1e-6), 1.0);
        float weight = chords[i].weight * chords[i].weight / (outshines * outshines * outshines);
        mean.light.color += weight * chords[i].light.color;
        mean.light.coc += weight * chords[i].light.coc;
#ifdef SEES_NEIGHBOURS
        float path_weight = weight * chords[i].path_weight;
        mean.path += path_weight * chords[i].path;
        mean.path_weight += path_weight;
#endif
        mean.weight += weight;
    }
    if (mean.weight == 0.0) return Patch(mean, 0.0, false);
    mean.light.color /= mean.weight;
    mean.light.coc /= mean.weight;
#ifdef SEES_NEIGHBOURS
    mean.path /= max(mean.path_weight, 1e-30);
#endif
    return Patch(mean, trust, true);
}

// What lies behind a thing may itself be thin.
Patch patch_at(vec2 center, Light own) {
    Patch patched;
    Light surface = own;
    float reach_px = abs(own.coc) + 1.5;
    int things = 0;
    do {
        Patch next = patch_behind(center, surface, reach_px, things > 0);
        if (things == 0 || next.is_there) patched = next;
        if (!next.is_there) break;
        surface = next.mean.light;
        reach_px = -surface.coc;
    } while (surface.coc < -kThinPx && ++things <= 2);
    return patched;
}
