#include <behind.glsl>

// What the capture's second layer has where a thing has moved away.
#if defined(HAS_SECOND) && defined(HAS_SECOND_VELOCITY)
#define KNOWS_BEHIND

// The path of what lies behind the thing at a pixel.
vec4 path_behind(vec2 place) {
    vec2 since = finite(texelFetch(second_velocity, texel_at(place), 0).xy);
    return motion_of(since, since, 1.0, 0.0).path;
}

// Alpha 0 where the layer shows nothing. `path`: a first guess of what lies behind.
vec4 known_behind(vec2 point, vec4 path, float t) {
    vec2 from = point - way_px(path, t);
    from = point - way_px(path_behind(from), t);
    return covering(texelFetch(second, texel_at(from), 0));
}
#endif
