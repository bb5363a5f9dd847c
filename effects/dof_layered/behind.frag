#version 450 core
#include <pass>
#include <lens/neighbours.glsl>

// What the frames before and after show of the surface that a pixel hides. Chords through the pixel are walked to the surface behind
// its own at both ends, whose motion tells where to look.
const int kChords = 8;
const float kLeastBehindPx = 1.0;  // difference of CoC radii from which on a surface is behind another
const float kOneSurface = 2.0;     // and below which two ends are on one
const float kTrustPx = 8.0;        // times the square of a chord's length, px: how far off a view may lie to be like its ends
const float kUnlike = 0.02;        // relative difference of ends that halves the trust

struct End {
    ivec2 place;
    float coc_px, distance_px;  // negative where nothing was found
};

End walk(vec2 center, float own_px, vec2 direction, float reach_px) {
    for (float at_px = 1.0; at_px <= reach_px; at_px += max(1.0, floor(at_px / 8.0))) {
        vec2 q = center + at_px * direction;
        if (any(lessThan(q, vec2(0.0))) || any(greaterThanEqual(q, vec2(frame.size)))) break;
        float coc_px = texelFetch(coc, ivec2(q), 0).r;
        if (coc_px > own_px + kLeastBehindPx) return End(ivec2(q), coc_px, at_px);
    }
    return End(ivec2(0), 0.0, -1.0);
}

Guess guess_of(End a, End b) {
    if (a.distance_px < 0.0 || b.distance_px > 0.0 && b.coc_px < a.coc_px) {
        End nearer = b;
        b = a;
        a = nearer;
    }
    vec3 color_a = texelFetch(color, a.place, 0).rgb, color_b = texelFetch(color, b.place, 0).rgb;
    if (b.distance_px < 0.0 || b.coc_px - a.coc_px > kOneSurface) return Guess(color_a, a.coc_px, path_at(a.place), 0.0);
    float length_px = a.distance_px + b.distance_px, part = a.distance_px / length_px;
    float unlike = amount(abs(color_a - color_b)) / max(amount(abs(color_a)) + amount(abs(color_b)), 1e-3);
    return Guess(mix(color_a, color_b, part), mix(a.coc_px, b.coc_px, part), mix(path_at(a.place), path_at(b.place), part),
                 kTrustPx * kUnlike / (length_px * length_px * (kUnlike + unlike)));
}

void main() {
    ivec2 p = ivec2(gl_FragCoord.xy);
    vec2 center = vec2(p) + 0.5;
    float own_px = texelFetch(coc, p, 0).r;
    View view = kNoView;
    for (int i = 0; i < kChords && abs(own_px) > kLeastBehindPx; ++i) {
        float angle = 3.14159265 * float(i) / float(kChords);
        vec2 direction = vec2(cos(angle), sin(angle));
        End a = walk(center, own_px, direction, abs(own_px) + 1.5), b = walk(center, own_px, -direction, abs(own_px) + 1.5);
        if (a.distance_px > 0.0 || b.distance_px > 0.0) view = seen_by_neighbours(p, guess_of(a, b), view);
    }
    bool is_seen = view.cost_px < kNoView.cost_px;
    out_behind = vec4(view.color.rgb, is_seen ? 1.0 : 0.0);
    out_behind_coc = view.coc_px;
}
