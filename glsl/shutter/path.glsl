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
const float kMiddle = kOpens + 0.5, kCloses = kOpens + 1.0;

vec2 way_px(vec4 path, float t) { return (path.xy + path.zw * t) * t; }

// The furthest that the path leads from its pixel, px.
float longest_way_px(vec4 path) {
    vec2 opens = way_px(path, kOpens), middle = way_px(path, kMiddle), closes = way_px(path, kCloses);
    return sqrt(max(max(dot(opens, opens), dot(closes, closes)), dot(middle, middle)));
}

// By the bits: isnan and isinf take software GL twice as long.
vec2 finite(vec2 v) {
    ivec2 magnitude = floatBitsToInt(v) & 0x7fffffff;
    return max(magnitude.x, magnitude.y) < 0x7f800000 ? v : vec2(0.0);
}

// From px per frame since the frame before and to the next, through -since, 0 and next at the times -1, 0 and 1; `scale`: a
// factor of the motion.
vec4 path_through(vec2 since, vec2 next, float scale) {
    vec2 span = shutter_span();
    float exposure = (span.y - span.x) * scale;
    return vec4(0.5 * (since + next) * exposure, 0.5 * (next - since) * exposure * exposure);
}
