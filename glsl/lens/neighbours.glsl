// What the frames before and after show of a surface behind a pixel, moved there by that surface's velocity. For effects with a
// parameter `background` and the inputs below, whose names end with the frame's distance beyond the first.
#include "highlight.glsl"
#include "lens.glsl"
#if BACKGROUND == BACKGROUND_NEIGHBOURS && defined(HAS_VELOCITY)
#define SEES_NEIGHBOURS

const float kAgreePx = 2.0;    // difference of CoC radii on one surface
const float kNearestPx = 1.0;  // a view further off shows another part of the surface
const float kFurtherPx = 0.05;  // added to the distance of a view, a frame: motion is uniform at short notice only

vec2 finite(vec2 way_px) { return any(isinf(way_px)) || any(isnan(way_px)) ? vec2(0.0) : way_px; }

// px per frame, from the frame before and to the frame after.
vec4 path_at(ivec2 p) {
    vec2 before = finite(texelFetch(velocity, p, 0).xy);
#ifdef HAS_VELOCITY_NEXT
    return vec4(before, finite(texelFetch(velocity_next, p, 0).xy));
#else
    return before.xyxy;
#endif
}

// What a pixel of this frame may hide.
struct Guess {
    vec3 color;
    float coc_px;
    vec4 path;
    float trust_px;  // how much further off a view may lie that has the guess's color
};

struct View {
    vec4 color;
    float coc_px;
    float cost_px;  // distance of its texel's centre from the point, and what speaks against it; infinite where there is no view
};

const View kNoView = View(vec4(0.0), 0.0, 1e30);

// Unfiltered: a filter would widen small lights.
View view_of(sampler2D view, sampler2D view_depth, ivec2 p, vec2 way_px, float frames, Guess guess, View best) {
    vec2 at = vec2(p) + 0.5 + frames * way_px;
    ivec2 q = ivec2(floor(at));
    if (any(lessThan(q, ivec2(0))) || any(greaterThanEqual(q, frame.size))) return best;
    float coc_px = coc_of(texelFetch(view_depth, q, 0).r, lens_at_infinity_px()), off_px = length(at - vec2(q) - 0.5);
    if (abs(coc_px - guess.coc_px) > kAgreePx || off_px > kNearestPx) return best;
    vec4 color = texelFetch(view, q, 0);
    float both = amount(abs(color.rgb)) + amount(abs(guess.color));
    float unlike = amount(abs(color.rgb - guess.color)) / max(both, 1e-3);
    float cost_px = off_px + kFurtherPx * frames + guess.trust_px * unlike;
    return cost_px < best.cost_px ? View(color, coc_px, cost_px) : best;
}

// The better of `best` and what the frames show.
View seen_by_neighbours(ivec2 p, Guess guess, View best) {
    vec2 before = -guess.path.xy, after = guess.path.zw;
#if defined(HAS_COLOR_BEFORE) && defined(HAS_DEPTH_BEFORE)
    best = view_of(color_before, depth_before, p, before, 1.0, guess, best);
#endif
#if defined(HAS_COLOR_AFTER) && defined(HAS_DEPTH_AFTER)
    best = view_of(color_after, depth_after, p, after, 1.0, guess, best);
#endif
#if defined(HAS_COLOR_BEFORE_2) && defined(HAS_DEPTH_BEFORE_2)
    best = view_of(color_before_2, depth_before_2, p, before, 2.0, guess, best);
#endif
#if defined(HAS_COLOR_AFTER_2) && defined(HAS_DEPTH_AFTER_2)
    best = view_of(color_after_2, depth_after_2, p, after, 2.0, guess, best);
#endif
#if defined(HAS_COLOR_BEFORE_3) && defined(HAS_DEPTH_BEFORE_3)
    best = view_of(color_before_3, depth_before_3, p, before, 3.0, guess, best);
#endif
#if defined(HAS_COLOR_AFTER_3) && defined(HAS_DEPTH_AFTER_3)
    best = view_of(color_after_3, depth_after_3, p, after, 3.0, guess, best);
#endif
    return best;
}
#endif
