// The image that the look wired, else the role that goes with the mode.
#include "mode.glsl"

#ifdef HAS_IMAGE
// The texel that covers a pixel. A grid of tiles may end beyond the picture, so sizes alone give a texel's side only where one
// fits both; any other image is stretched.
ivec2 image_texel(ivec2 p) {
    ivec2 size = ivec2(image_size.xy), per = (frame.size + size - 1) / size;
    int side = param.texel > 0 ? param.texel : max(per.x, per.y);
    bool fits = param.texel > 0 || (frame.size + side - 1) / side == size;
    ivec2 texel = fits ? p / side : ivec2((vec2(p) + 0.5) * vec2(size) / vec2(frame.size));
    return clamp(texel, ivec2(0), size - 1);
}
#endif

// Zero where there is none.
vec4 data_at(ivec2 p) {
#if SHOW == SHOW_OBJECT_ID
    return vec4(0.0);
#elif defined(HAS_IMAGE)
    vec4 texel = texelFetch(image, image_texel(p), 0);
    int c = param.channel;
    return vec4(texel[c], texel[min(c + 1, 3)], texel[min(c + 2, 3)], 1.0);
#elif defined(SHOWS_VECTORS) && defined(HAS_VELOCITY)
    return texelFetch(velocity, p, 0);
#elif SHOW == SHOW_DEPTH && defined(HAS_DEPTH)
    return texelFetch(depth, p, 0);
#elif SHOW == SHOW_NORMAL && defined(HAS_NORMAL)
    return texelFetch(normal, p, 0);
#elif SHOW == SHOW_LIGHT && defined(HAS_COLOR)
    return texelFetch(color, p, 0);
#else
    return vec4(0.0);
#endif
}

// The channels that the mode looks at; the others as the first, which adds no fault.
vec3 shown_channels(vec4 data) {
#if SHOW == SHOW_NORMAL || SHOW == SHOW_LIGHT
    return data.rgb;
#elif defined(SHOWS_VECTORS)
    return data.rgr;
#else
    return data.rrr;
#endif
}

int faults_of(vec4 data) {
    vec3 v = shown_channels(data);
    int faults = any(isnan(v)) ? kNan : 0;
#if SHOW == SHOW_DEPTH
    bool nothing = isinf(v.x) && v.x > 0.0;
    faults |= nothing ? kNothingHit : 0;
    faults |= isinf(v.x) && !nothing ? kInfinite : 0;
#else
    faults |= any(isinf(v)) ? kInfinite : 0;
#endif
#if SHOW == SHOW_DEPTH || SHOW == SHOW_LIGHT
    faults |= any(lessThan(v, vec3(0.0))) ? kNegative : 0;
#elif SHOW == SHOW_SCALAR
    faults |= v.x < 0.0 && param.low >= 0.0 ? kNegative : 0;
#endif
    return faults;
}

// What the scale is for; only of sound data.
float amount_of(vec4 data) {
#ifdef SHOWS_VECTORS
    vec2 sizes = abs(data.xy);
    float most = max(sizes.x, sizes.y);
    return most > 1e18 ? most : length(sizes);  // whose square would be infinite
#elif SHOW == SHOW_SIGNED
    return abs(data.r);
#else
    return data.r;
#endif
}
