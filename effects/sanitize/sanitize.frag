#version 450 core
#include <pass>
#include <luminance.glsl>

const int kNeighbours = 8;

bool is_nan(vec4 v) { return any(isnan(v)); }
bool is_inf(vec4 v) { return any(isinf(v)); }
bool is_negative(vec4 v) { return any(lessThan(v, vec4(0.0))); }
bool is_sound(vec4 v) { return !is_nan(v) && !is_inf(v) && !is_negative(v); }

// Sorts `values[0 .. count - 1]`; eight at the most, so the shortest way is the best.
void sort(inout float values[kNeighbours], int count) {
    for (int i = 1; i < count; ++i) {
        float value = values[i];
        int j = i - 1;
        for (; j >= 0 && values[j] > value; --j) values[j + 1] = values[j];
        values[j + 1] = value;
    }
}

float median(float values[kNeighbours], int count) {
    if (count == 0) return 0.0;
    sort(values, count);
    return count % 2 == 1 ? values[count / 2] : 0.5 * (values[count / 2 - 1] + values[count / 2]);
}

// The sound pixels among the eight neighbours; those outside the image are left out.
int gather(ivec2 p, out vec4 neighbours[kNeighbours]) {
    int count = 0;
    for (int y = -1; y <= 1; ++y)
        for (int x = -1; x <= 1; ++x) {
            ivec2 q = p + ivec2(x, y);
            bool inside = all(greaterThanEqual(q, ivec2(0))) && all(lessThan(q, ivec2(color_size.xy)));
            if ((x == 0 && y == 0) || !inside) continue;
            vec4 tap = texelFetch(color, q, 0);
            if (is_sound(tap)) neighbours[count++] = tap;
        }
    return count;
}

vec4 median_of(vec4 neighbours[kNeighbours], int count) {
    vec4 result;
    for (int c = 0; c < 4; ++c) {
        float values[kNeighbours];
        for (int i = 0; i < count; ++i) values[i] = neighbours[i][c];
        result[c] = median(values, count);
    }
    return result;
}

void main() {
    ivec2 p = ivec2(gl_FragCoord.xy);
    vec4 texel = texelFetch(color, p, 0);
    vec4 neighbours[kNeighbours];
    int count = gather(p, neighbours);
    vec4 middle = median_of(neighbours, count);
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

    float limit = param.firefly_factor * max(luminance(middle.rgb), param.firefly_floor);
    float light = luminance(mended.rgb);
    fault.w = is_sound(mended) && count > 0 && light > limit;
#if FIREFLY == FIREFLY_CLAMP
    if (fault.w) mended.rgb *= limit / light;
#elif FIREFLY == FIREFLY_MEDIAN
    if (fault.w) mended = vec4(middle.rgb, mended.a);
#endif

    out_color = mended;
    out_faults = vec4(fault);
}
