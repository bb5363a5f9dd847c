// What the capture's second layer has behind a pixel.
#if defined(HAS_SECOND) && defined(HAS_SECOND_DEPTH)
#define KNOWS_BEHIND
#include <lens/lens.glsl>

const float kLeastAlpha = 0.5;

bool is_known(ivec2 p) { return texelFetch(second, p, 0).a > kLeastAlpha; }

Light known_behind(ivec2 p) {
    vec4 behind = texelFetch(second, p, 0);
    return Light(behind / behind.a, coc_of(texelFetch(second_depth, p, 0).r, lens_at_infinity_px()));
}
#endif
