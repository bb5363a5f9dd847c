#version 450 core
#include <pass>
#include <color_luminance.glsl>

bool is_nan(vec4 v) { return any(isnan(v)); }
bool is_inf(vec4 v) { return any(isinf(v)); }
bool is_negative(vec4 v) { return any(lessThan(v, vec4(0.0))); }
bool is_sound(vec4 v) { return !is_nan(v) && !is_inf(v) && !is_negative(v); }

// Above every sound value, or equal to it: what stands for a neighbour that is not sound.
const float kLargest = 3.4028235e38;

// The pixel, if it is sound and inside the image; `count` is then one more.
vec4 neighbour(ivec2 p, inout int count) {
    ivec2 last = ivec2(color_size.xy) - 1;
    vec4 tap = texelFetch(color, clamp(p, ivec2(0), last), 0);
    bool counts = is_sound(tap) && p == clamp(p, ivec2(0), last);
    count += counts ? 1 : 0;
    return mix(vec4(kLargest), tap, bvec4(counts));
}

void order(inout vec4 low, inout vec4 high) {
    vec4 least = min(low, high);
    high = max(low, high);
    low = least;
}

// The median, channel by channel, of the sound pixels among the eight neighbours. A network sorts all eight by 19 comparisons,
// the fewest possible (Knuth 1998, The Art of Computer Programming 3, section 5.3.4): llvmpipe takes ten times as long for an
// array with computed indices.
vec4 median_around(ivec2 p, out int count) {
    count = 0;
    vec4 a = neighbour(p + ivec2(-1, -1), count), b = neighbour(p + ivec2(0, -1), count);
    vec4 c = neighbour(p + ivec2(1, -1), count), d = neighbour(p + ivec2(-1, 0), count);
    vec4 e = neighbour(p + ivec2(1, 0), count), f = neighbour(p + ivec2(-1, 1), count);
    vec4 g = neighbour(p + ivec2(0, 1), count), h = neighbour(p + ivec2(1, 1), count);
    order(a, c); order(b, d); order(e, g); order(f, h);
    order(a, e); order(b, f); order(c, g); order(d, h);
    order(a, b); order(c, d); order(e, f); order(g, h);
    order(c, e); order(d, f);
    order(b, e); order(d, g);
    order(b, c); order(d, e); order(f, g);
    vec4 below = count <= 2 ? a : count <= 4 ? b : count <= 6 ? c : d;
    vec4 above = count <= 1 ? a : count <= 3 ? b : count <= 5 ? c : count <= 7 ? d : e;
    if (count == 0) return vec4(0.0);
    return (count & 1) == 1 ? above : 0.5 * (below + above);
}

void main() {
    ivec2 p = ivec2(gl_FragCoord.xy);
    vec4 texel = texelFetch(color, p, 0);
    int count;
    vec4 middle = median_around(p, count);
    bvec4 fault = bvec4(is_nan(texel), is_inf(texel), is_negative(texel), false);
    vec4 mended = texel;

#if NAN == NAN_CLAMP
    mended = mix(mended, vec4(0.0), isnan(texel));
#elif NAN == NAN_MEDIAN
    if (fault.x) mended = middle;
#endif

#if INF == INF_CLAMP
    mended = mix(mended, mix(vec4(0.0), vec4(param.max_value), greaterThan(texel, vec4(0.0))), isinf(mended));
#elif INF == INF_MEDIAN
    if (is_inf(mended)) mended = middle;
#endif

#if NEGATIVE == NEGATIVE_CLAMP
    mended = mix(mended, vec4(0.0), lessThan(mended, vec4(0.0)));
#elif NEGATIVE == NEGATIVE_MEDIAN
    if (is_negative(mended)) mended = middle;
#endif

    float limit = param.firefly_factor * max(color_luminance(middle.rgb), param.firefly_floor);
    float light = color_luminance(mended.rgb);
    fault.w = is_sound(mended) && count > 0 && light > limit;
#if FIREFLY == FIREFLY_CLAMP
    if (fault.w) mended.rgb *= limit / light;
#elif FIREFLY == FIREFLY_MEDIAN
    if (fault.w) mended = vec4(middle.rgb, mended.a);
#endif

    out_color = mended;
    out_faults = vec4(fault);
}
