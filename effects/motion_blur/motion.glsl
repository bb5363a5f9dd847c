// Motion of a pixel while the shutter is open.
#include <shutter/path.glsl>

const float kFurthestTime = max(abs(kOpens), abs(kCloses));

const int kTile = 16;        // side in px of the tiles, as effect.json declares it
const int kCell = 8;         // side in px of a quarter of a tile, likewise
const float kLeastWay = 0.25;  // px; less is no blur
const float kAlike = 0.5;    // px that paths are apart and still the same motion
const float kInFront = 1.03;  // times the depth of what is in front, from which on another thing is behind it
const int kTimes = 32;       // of the exposure that one word has bits for

// What lies behind is in layers of the capture, and which share of a pixel the nearest surface has.
#if defined(HAS_SECOND) && defined(HAS_SECOND_VELOCITY)
#define KNOWS_LAYERS
#if defined(HAS_FIRST) && defined(HAS_FIRST_VELOCITY) && defined(HAS_FIRST_DEPTH)
#define SHARES_PIXELS
#endif
#endif

struct Motion {
    vec4 path;
    float depth_m;
    float share;  // of the pixel
};

// The numbers of a path whose longest way is max_blur are at most 6 times as large. 16 bits keep them to 1/4000 of max_blur.
float path_range_px() { return 8.0 * param.max_blur; }

uvec2 pack_path(vec4 path) {
    // Not packSnorm2x16, which clamps what is within the range already.
    ivec4 part = ivec4(roundEven(path * (32767.0 / path_range_px())));
    return uvec2((part.xz & 0xffff) | part.yw << 16);
}

// Each in the upper half of a word. Not unpackSnorm2x16, which takes software GL twice as long.
ivec4 packed_numbers(uvec2 words) { return ivec4(words.x << 16, words.x & 0xffff0000u, words.y << 16, words.y & 0xffff0000u); }

vec4 unpack_path(uvec2 words) { return vec4(packed_numbers(words)) * (path_range_px() / (65536.0 * 32767.0)); }

uvec4 pack_motion(Motion m) { return uvec4(pack_path(m.path), floatBitsToUint(vec2(m.depth_m, m.share))); }

Motion unpack_motion(uvec4 texel) {
    vec2 depth_share = uintBitsToFloat(texel.zw);
    return Motion(unpack_path(texel.xy), depth_share.x, depth_share.y);
}

// From px per frame since the frame before and to the next; `scale`: a factor of the motion.
Motion motion_of(vec2 since, vec2 next, float scale, float depth_m) {
    vec4 path = path_through(since, next, scale);
    return Motion(path * (param.max_blur / max(longest_way_px(path), param.max_blur)), depth_m, 1.0);
}

bool is_alike(vec4 path, vec4 other) {
    vec4 apart = abs(path - other);
    vec2 apart_px = (apart.xy + apart.zw * kFurthestTime) * kFurthestTime;
    return max(apart_px.x, apart_px.y) <= kAlike;
}

// From where it opens to where it closes, an exposure later.
float sweep_px(vec4 path) { return length(path.xy + path.zw * (kOpens + kCloses)); }

// One a px of the sweep, at least two: the loops over them test at their end, because llvmpipe runs the body of the others
// once more, with every pixel masked.
int tap_count(vec4 path) { return clamp(int(ceil(sweep_px(path))), 2, param.samples); }
