#include <lens/highlight.glsl>
#include "loads.glsl"
#include <lens/neighbours.glsl>

// What lies behind a surface near its silhouette, continued from both ends of chords through the pixel. Chords whose ends are
// alike and close count most: they run along the edges of what is hidden. Where the first chords lead to one colour, they are enough.
// Where all of them contradict each other, an edge may run along the silhouette, and only chords in its direction are right: finer
// turns find them. This is guessed, and shows through a blur only. Where the capture has a second layer, that is the patch.
const int kFirstChords = 4;
#ifdef GUESSES
const int kChords = 8;  // for the mean of neighbours
#else
const int kChords = 16;
const int kFineChords = 32;  // of fewer, none may run along an edge
#endif
const float kAgreement = 0.02;      // relative difference of chords from their mean, up to which they are of one colour
const float kContradiction = 0.05;  // and from which on they contradict each other
const float kOneSurface = 2.0;      // difference of CoC radii of ends on one surface, px
const float kOnePathPx = 0.5;       // and of the pixel whose motion an end has
const float kOutshines = 8.0;       // light of one end that does not continue behind the other
const float kUnlike = 0.02;         // relative difference of ends that halves a chord's weight
const float kFineUnlike = 0.01;     // the same in finer turns
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
    float unlike;  // relative difference of its ends
    float length_px;
};

Chord chord_of(Light light, End a, End b, float part, float weight, float unlike, float length_px) {
#ifdef SEES_NEIGHBOURS
    return Chord(light, mix(a.path, b.path, part), min(a.path_weight, b.path_weight), weight, unlike, length_px);
#else
    return Chord(light, weight, unlike, length_px);
#endif
}

// Of two ends on one surface.
Chord chord_between(End a, End b) {
    float length_px = a.distance_px + b.distance_px, part = a.distance_px / length_px;
    float way = part;
    float amount_a = amount(a.light.color.rgb), amount_b = amount(b.light.color.rgb);
    if (amount_a > kOutshines * amount_b) part = 1.0;
    if (amount_b > kOutshines * amount_a) part = 0.0;
    float unlike = amount(abs(a.light.color.rgb - b.light.color.rgb)) / max(amount_a + amount_b, 1e-3);
    return chord_of(Light(mix(a.light.color, b.light.color, part), mix(a.light.coc, b.light.coc, part)), a, b, way,
                    1.0 / (length_px * length_px * (kUnlike + unlike)), unlike, length_px);
}

// `is_thin`: only chords whose ends both lie within the reach.
Chord chord_through(vec2 center, Light own, vec2 direction, float reach_px, bool is_thin) {
    Walks walks = walk_chord(center, own.coc, direction, reach_px);
    End a = end_at(center, direction, walks.a.distance_px), b = end_at(center, -direction, walks.b.distance_px);
    bool has_a = a.distance_px > 0.0, has_b = b.distance_px > 0.0;
    if (!has_a && !has_b) return chord_of(own, a, a, 0.0, 0.0, 0.0, 0.0);
    if (is_thin && (!has_a || !has_b || a.distance_px + b.distance_px > reach_px)) return chord_of(own, a, a, 0.0, 0.0, 0.0, 0.0);
    if (!has_a || !has_b || abs(a.light.coc - b.light.coc) > kOneSurface) {
        End end = !has_b || has_a && a.distance_px < b.distance_px ? a : b;
        float length_px = 2.0 * end.distance_px + reach_px;
        return chord_of(end.light, end, end, 0.0, 1.0 / (length_px * length_px), 0.0, length_px);
    }
    return chord_between(a, b);
}

// Chords that lead to one surface, as sums: an array of them took software GL 1.4 times as long.
struct Bundle {
    Chord sum;
    float first_coc, best, darkest;
    float unlike, square;  // relative differences of ends; squares of colours
    int chords;
};

Bundle empty_bundle(Chord chord) {
    chord.light = Light(vec4(0.0), 0.0);
    chord.weight = 0.0;
#ifdef SEES_NEIGHBOURS
    chord.path = vec4(0.0);
    chord.path_weight = 0.0;
#endif
    return Bundle(chord, 0.0, 0.0, 1e30, 0.0, 0.0, 0);
}

// Light that outshines the darkest chord so far counts little behind the silhouette. Chords before a darker one keep
// part of their weight.
void add_chord(inout Bundle bundle, Chord chord, float weight) {
    float own = max(amount(chord.light.color.rgb), 0.0);
    float before = clamp((kOutshines * own + 1e-6) / bundle.darkest, 0.0, 1.0), outshines = max(own / (kOutshines * bundle.darkest + 1e-6), 1.0);
    before = weight > 0.0 ? before * before * before : 1.0;
    weight /= outshines * outshines * outshines;
    bundle.sum.light.color = before * bundle.sum.light.color + weight * chord.light.color;
    bundle.sum.light.coc = before * bundle.sum.light.coc + weight * chord.light.coc;
#ifdef SEES_NEIGHBOURS
    float path_weight = weight * chord.path_weight;
    bundle.sum.path = before * bundle.sum.path + path_weight * chord.path;
    bundle.sum.path_weight = before * bundle.sum.path_weight + path_weight;
#endif
    bundle.sum.weight = before * bundle.sum.weight + weight;
    bundle.unlike = before * bundle.unlike + weight * chord.unlike;
    bundle.square = before * bundle.square + weight * dot(chord.light.color.rgb, chord.light.color.rgb);
    bundle.darkest = weight > 0.0 ? min(bundle.darkest, own) : bundle.darkest;
    bundle.first_coc = bundle.chords == 0 ? chord.light.coc : bundle.first_coc;
    bundle.chords += weight > 0.0 ? 1 : 0;
    bundle.best = weight > 0.0 ? max(bundle.best, chord.weight) : bundle.best;
}

Chord mean_of(Chord sum) {
    float scale = 1.0 / max(sum.weight, 1e-30);
    sum.light = Light(scale * sum.light.color, scale * sum.light.coc);
#ifdef SEES_NEIGHBOURS
    sum.path /= max(sum.path_weight, 1e-30);
#endif
    return sum;
}

// Mean relative difference of the chords' colours and ends.
float spread_of(Bundle bundle) {
    float scale = 1.0 / max(bundle.sum.weight, 1e-30);
    vec3 mean = scale * bundle.sum.light.color.rgb;
    float square = max(scale * bundle.square - dot(mean, mean), 0.0);
    return sqrt(square / max(dot(mean, mean), 1e-6)) + scale * bundle.unlike;
}

bool is_of(Bundle bundle, Chord chord) { return bundle.chords == 0 || abs(chord.light.coc - bundle.first_coc) <= kOneSurface; }

// The first chords are spread over all directions, so that they can stand for the others, which lie between them.
vec2 direction_of(int i) {
    const int kBetween = kChords / kFirstChords - 1;
    int later = i - kFirstChords;
    int turn = later < 0 ? i * (kBetween + 1) : later / kBetween * (kBetween + 1) + 1 + later % kBetween;
    float angle = 3.14159265 / float(kChords) * float(turn);
    return vec2(cos(angle), sin(angle));
}

struct Patch {
    Chord mean;  // of all chords to one surface
    float trust;  // in the best of them: one over the square of its length, px, if its ends are alike
    bool is_there;
};

#ifndef GUESSES
// How far it is to the surface of `coc`, past nearer ones; negative where something further comes first.
float distance_to(vec2 center, float own_coc, float coc, vec2 direction, float reach_px) {
    float bound = max(coc - kOneSurface, own_coc + kClear);
    float end_px = min(reach_px, outside_from_px(center, direction)), at_px = 1.0, tap_coc = 0.0, tap_px = 0.0;
    do {
        int level = level_of(at_px);
        ivec2 q = ivec2(center + at_px * direction);
        tap_coc = level == 0 ? coc_near(q) : coarse_coc_at(q >> level, grid_of(level));
        tap_px = at_px;
        at_px += float(1 << level);
    } while (tap_coc <= bound && at_px < end_px);
    return tap_px < end_px && tap_coc > bound && tap_coc < coc + kOneSurface ? tap_px : -1.0;
}

// By chords whose ends both lie on the surface of `mean`. Likeness counts more here.
Chord finely_turned(vec2 center, float own_coc, Bundle bundle, Chord mean, float reach_px) {
    const float kTurn = 3.14159265 / float(kFineChords);
    const mat2 kTurned = mat2(cos(kTurn), sin(kTurn), -sin(kTurn), cos(kTurn));
    Bundle fine = empty_bundle(mean);
    fine.darkest = bundle.darkest;
    vec2 direction = vec2(1.0, 0.0);
    int i = 0;
    do {
        float a_px = distance_to(center, own_coc, mean.light.coc, direction, reach_px), b_px = distance_to(center, own_coc, mean.light.coc, -direction, reach_px);
        Chord chord = chord_between(end_at(center, direction, abs(a_px)), end_at(center, -direction, abs(b_px)));
        float root = 1.0 / (chord.length_px * chord.length_px * (kFineUnlike + chord.unlike));
        add_chord(fine, chord, a_px > 0.0 && b_px > 0.0 ? root * root : 0.0);
        direction = kTurned * direction;
    } while (++i < kFineChords);
    return fine.sum.weight > 0.0 ? mean_of(fine.sum) : mean;
}
#endif

// What lies behind `own`, a surface at the pixel.
Patch patch_behind(vec2 center, Light own, float reach_px, bool is_thin) {
    Chord chord = chord_through(center, own, direction_of(0), reach_px, is_thin);
    Bundle one = empty_bundle(chord), other = one;
    int count = 1;
    bool is_agreed = false;
    add_chord(one, chord, chord.weight * chord.weight);
    do {
        chord = chord_through(center, own, direction_of(count), reach_px, is_thin);
        bool is_one = is_of(one, chord);
        if (!is_one && !is_of(other, chord) && chord.weight > other.best) other = empty_bundle(chord);
        float weight = chord.weight * chord.weight;
        add_chord(one, chord, is_one ? weight : 0.0);
        add_chord(other, chord, !is_one && is_of(other, chord) ? weight : 0.0);
        is_agreed = ++count == kFirstChords && other.chords == 0 && one.chords > 1 && spread_of(one) <= kAgreement;
    } while (count < kChords && !is_agreed);
    if (other.best > one.best) one = other;
    Chord mean = mean_of(one.sum);
    if (one.sum.weight == 0.0) return Patch(mean, 0.0, false);
#ifndef GUESSES
    if (!is_agreed && !is_thin && spread_of(one) > kContradiction) mean = finely_turned(center, own.coc, one, mean, reach_px);
#endif
    return Patch(mean, kUnlike * one.best, true);
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
