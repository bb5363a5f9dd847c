// Paths of points over the time that the shutter is open: at time t, in exposures from the frame's own, a point is
// (path.xy + path.zw t) t px from where it is at the frame's own time.
#include <shutter/shutter.glsl>

#if SHUTTER_PHASE == SHUTTER_PHASE_START
const float kOpens = 0.0;  // exposures from the frame's own time
#elif SHUTTER_PHASE == SHUTTER_PHASE_END
const float kOpens = -1.0;
#else
const float kOpens = -0.5;
#endif

vec2 way_px(vec4 path, float t) { return (path.xy + path.zw * t) * t; }

// The furthest that the path leads from its pixel, px.
float longest_way_px(vec4 path) {
    return max(length(way_px(path, kOpens)), max(length(way_px(path, kOpens + 0.5)), length(way_px(path, kOpens + 1.0))));
}

vec2 finite(vec2 v) { return any(isnan(v)) || any(isinf(v)) ? vec2(0.0) : v; }

// From px per frame since the frame before and to the next.
vec4 path_of(vec2 since, vec2 next) {
    vec2 span = shutter_span();
    float exposure = span.y - span.x;
    // Through -since, 0 and next at the times -1, 0 and 1.
    vec4 path = vec4(0.5 * (since + next) * exposure, 0.5 * (next - since) * exposure * exposure);
    float way = longest_way_px(path);
    return way > param.max_blur ? path * (param.max_blur / way) : path;
}
