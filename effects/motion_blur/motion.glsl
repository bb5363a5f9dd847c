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
const float kFurthestTime = max(abs(kOpens), abs(kCloses));

const int kTile = 16;        // side in px of the tiles, as effect.json declares it
const float kLeastWay = 0.25;  // px; less is no blur
const float kAlike = 0.5;    // px that paths are apart and still the same motion

vec2 way_px(vec4 path, float t) { return (path.xy + path.zw * t) * t; }

// The furthest that the path leads from its pixel, px.
float longest_way_px(vec4 path) {
    vec2 opens = way_px(path, kOpens), middle = way_px(path, kMiddle), closes = way_px(path, kCloses);
    return sqrt(max(max(dot(opens, opens), dot(closes, closes)), dot(middle, middle)));
}

struct Motion {
    vec4 path;
    float depth_m;
    float way_px;  // the longest
};

// The numbers of a path whose longest way is max_blur are at most 6 times as large. 16 bits keep them to 1/4000 of max_blur.
float path_range_px() { return 8.0 * param.max_blur; }

uvec4 pack_motion(Motion m) {
    vec4 part = m.path / path_range_px();
    return uvec4(packSnorm2x16(part.xy), packSnorm2x16(part.zw), floatBitsToUint(m.depth_m), floatBitsToUint(m.way_px));
}

Motion unpack_motion(uvec4 texel) {
    vec4 part = vec4(unpackSnorm2x16(texel.x), unpackSnorm2x16(texel.y));
    return Motion(part * path_range_px(), uintBitsToFloat(texel.z), uintBitsToFloat(texel.w));
}

vec2 finite(vec2 v) { return any(isnan(v)) || any(isinf(v)) ? vec2(0.0) : v; }

// From px per frame since the frame before and to the next; `scale`: a factor of the motion.
Motion motion_of(vec2 since, vec2 next, float scale, float depth_m) {
    vec2 span = shutter_span();
    float exposure = (span.y - span.x) * scale;
    // Through -since, 0 and next at the times -1, 0 and 1.
    vec4 path = vec4(0.5 * (since + next) * exposure, 0.5 * (next - since) * exposure * exposure);
    float way = longest_way_px(path);
    if (way > param.max_blur) {
        path *= param.max_blur / way;
        way = param.max_blur;
    }
    return Motion(path, depth_m, way);
}
