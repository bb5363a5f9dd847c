#include <lens/lens.glsl>

// What the frames before and after show of the surface behind a pixel, moved there by that surface's velocity.
#if BACKGROUND == BACKGROUND_NEIGHBOURS && defined(HAS_VELOCITY)
#define SEES_NEIGHBOURS

const float kAgreePx = 2.0;  // difference of CoC radii on one surface

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

struct View {
    vec4 color;
    float off_px;  // of its texel's centre from where the point is; infinite where it shows something else
};

// Unfiltered: a filter would widen small lights.
View view_of(sampler2D view, sampler2D view_depth, vec2 at, float coc_px, View other) {
    ivec2 q = ivec2(floor(at));
    if (any(lessThan(q, ivec2(0))) || any(greaterThanEqual(q, frame.size))) return other;
    if (abs(coc_of(texelFetch(view_depth, q, 0).r, lens_at_infinity_px()) - coc_px) > kAgreePx) return other;
    float off_px = length(at - vec2(q) - 0.5);
    return off_px < other.off_px ? View(texelFetch(view, q, 0), off_px) : other;
}

View seen_by_neighbours(ivec2 p, float coc_px, vec4 path) {
    vec2 center = vec2(p) + 0.5;
    View view = View(vec4(0.0), 1e9);
#if defined(HAS_COLOR_BEFORE) && defined(HAS_DEPTH_BEFORE)
    view = view_of(color_before, depth_before, center - path.xy, coc_px, view);
#endif
#if defined(HAS_COLOR_AFTER) && defined(HAS_DEPTH_AFTER)
    view = view_of(color_after, depth_after, center + path.zw, coc_px, view);
#endif
    return view;
}
#endif
