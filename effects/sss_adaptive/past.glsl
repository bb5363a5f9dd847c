// Where a pixel's surface was in the frame before.

vec2 past_place() {
    vec2 motion = vec2(0.0);
#ifdef HAS_VELOCITY
    motion = texelFetch(velocity, ivec2(gl_FragCoord.xy), 0).xy;
#endif
    return gl_FragCoord.xy - motion;
}

// Nearest pixel of the frame before, and whether that is in the picture.
bool past_pixel(out ivec2 pixel) {
    vec2 place = past_place();
    pixel = clamp(ivec2(floor(place)), ivec2(0), frame.size - 1);
    return frame.history_valid && all(greaterThanEqual(place, vec2(0.0))) && all(lessThan(place, vec2(frame.size)));
}

// An object's key as a float, exact: never 0 for what scatters; keys that differ by 2^24 are taken for one object.
float key_of(uint key) { return key == 0u ? 0.0 : float(key & 0xFFFFFFu) + 1.0; }
