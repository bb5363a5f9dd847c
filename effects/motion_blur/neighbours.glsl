// What the frames before and after show at the place that a point behind `beside` has there, where that is further away than
// the thing that hides it now.
const float kBehind = 1.03;  // times the depth of what hides it

vec4 uncovered(vec2 point, vec2 beside, Motion own, float t, vec4 color_beside) {
    vec4 path = motion_at(beside).path;
    vec2 span = shutter_span(), now = point - way_px(path, t);
    float frames = 1.0 / max(span.y - span.x, 1e-6);  // a frame, in exposures
    vec4 sum = vec4(0.0);
    float views = 0.0;
#if defined(HAS_COLOR_BEFORE) && defined(HAS_DEPTH_BEFORE)
    vec2 before = now + way_px(path, -frames);
    if (texelFetch(depth_before, texel_at(before), 0).r > kBehind * own.depth_m) {
        sum += textureLod(color_before, before * color_before_size.zw, 0.0);
        views += 1.0;
    }
#endif
#if defined(HAS_COLOR_AFTER) && defined(HAS_DEPTH_AFTER)
    vec2 after = now + way_px(path, frames);
    if (texelFetch(depth_after, texel_at(after), 0).r > kBehind * own.depth_m) {
        sum += textureLod(color_after, after * color_after_size.zw, 0.0);
        views += 1.0;
    }
#endif
    return views > 0.0 ? sum / views : color_beside;
}
