// Shading samples: the pixels of the picture, of the layers behind it, and of an estimate where the capture has none.
#include <lens/lens.glsl>
#include "path.glsl"

const float kWhole = 0.98, kNothing = 0.02;  // of a pixel

struct Surfel {
    float depth_m;
    float coc_px;
    vec4 path;
    float share;  // of its pixel, in what lies no nearer
};

vec4 path_at(ivec2 p) {
#ifdef HAS_VELOCITY
    vec2 since = finite(texelFetch(velocity, p, 0).xy);
#ifdef HAS_VELOCITY_NEXT
    return path_of(since, finite(texelFetch(velocity_next, p, 0).xy));
#else
    return path_of(since, since);
#endif
#else
    return vec4(0.0);
#endif
}

float reach_px(float coc_px, vec4 path) { return abs(coc_px) + longest_way_px(path); }
