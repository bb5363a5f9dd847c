// Where a pixel's surface was in the frame before.
#include "kept_key.glsl"
#include "shares.glsl"

vec2 past_place() {
    vec2 motion = vec2(0.0);
#ifdef HAS_VELOCITY
    motion = texelFetch(velocity, ivec2(gl_FragCoord.xy), 0).xy;
#endif
    return gl_FragCoord.xy - motion;
}

ivec2 pixel_at(vec2 place) { return clamp(ivec2(floor(place)), ivec2(0), frame.size - 1); }

// How far from its pixel's middle lies what the pixel's average is of. A surface that moves by part of a pixel would lose that
// part in each frame, were it always taken from the pixel's middle.
vec2 residual_at(ivec2 pixel) {
#if GUIDING
    return residual_of(texelFetch(guided_shares_prev, pixel, 0));
#else
    return vec2(0.0);
#endif
}

// The pixel of the frame before whose average is of the nearest place, and whether that is in the picture.
bool past_pixel(out ivec2 pixel) {
    vec2 place = past_place();
    pixel = pixel_at(place - residual_at(pixel_at(place)));
    return frame.history_valid && all(greaterThanEqual(place, vec2(0.0))) && all(lessThan(place, vec2(frame.size)));
}
