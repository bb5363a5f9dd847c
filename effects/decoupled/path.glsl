#include <shutter/path.glsl>

// From px per frame since the frame before and to the next.
vec4 path_of(vec2 since, vec2 next) {
    vec4 path = path_through(since, next, 1.0);
    float way = longest_way_px(path);
    return way > param.max_blur ? path * (param.max_blur / way) : path;
}
