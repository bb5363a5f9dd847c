// One skewed 1-D blur that spreads every texel by its own circle of confusion.
#include <lens/packing.glsl>
#include <lens/highlight.glsl>
#include <near_reach/tile.glsl>
#include "line.glsl"

// Light gathered from one side of the centre.
struct Sum {
    vec4 light;  // premultiplied RGB, alpha
    float weight;
    float coc;   // times weight and amount of light
};

int tap_limit(float extent_px) {
    int wanted = param.taps > 0 ? param.taps : clamp(2 * int(ceil(extent_px)) + 1, 9, 129);
    return (wanted - 1) / 2;
}

// How much of a tap `distance_px` away lies within `reach_px`; the last tap counts by the part of its step that is reached.
float cover(float reach_px, float distance_px, float step_px) {
    return clamp((reach_px - distance_px) / step_px + 0.5, 0.0, 1.0);
}

#if WEIGHTS == WEIGHTS_SEED
// Listing A.2 of Post 2013, with CoC as a fraction of the largest: what lies in front counts by its own blur, unless the
// centre is hardly more blurred than it.
float seed_weight(float centre_coc, float tap_coc) {
    float centre = abs(centre_coc) / param.max_coc_radius, tap = abs(tap_coc) / param.max_coc_radius;
    float weight = tap_coc < centre_coc ? tap * param.bleed_multiplier : 1.0;
    return clamp(centre > tap + param.bleed_bias ? weight : 1.0, 0.0, 1.0);
}
#endif

void add_tap(inout Sum front, inout Sum back, Light tap, float centre_coc, float across, float own_cover,
             float distance_px, float scale, float step_px) {
#if WEIGHTS == WEIGHTS_SEED
    float front_weight = 0.0;
    float back_weight = across * own_cover * seed_weight(centre_coc, tap.coc);
#else
    // 1: the tap lies in front of the centre and spreads over it as far as its own CoC reaches, thinned by that length.
    // 0: the centre sees it through its own aperture.
    float in_front = clamp(centre_coc - tap.coc, 0.0, 1.0);
    float reach_px = scale * abs(tap.coc);
    float front_weight = across * in_front * cover(reach_px, distance_px, step_px) * step_px / max(2.0 * reach_px, step_px);
    float back_weight = across * (1.0 - in_front) * own_cover;
#endif
    front.light += front_weight * tap.color;
    front.weight += front_weight;
    front.coc += front_weight * amount(tap.color.rgb) * tap.coc;
    back.light += back_weight * tap.color;
    back.weight += back_weight;
}

// The front over the mean of the back. The result keeps the centre's CoC for the second blur, unless most of its light is a
// highlight in front, which then spreads on by the highlight's.
Light combine_sums(Sum front, Sum back, float centre_coc) {
    vec4 behind = back.light / max(back.weight, 1e-6);
    float opacity = min(front.weight, 1.0);
    vec4 light = front.light / max(front.weight, 1.0) + behind * (1.0 - opacity);

    float front_amount = amount(front.light.rgb), back_amount = amount(behind.rgb);
    float excess = max(front_amount - kHighlight * front.weight * back_amount, 0.0);
    float share = front_amount > 0.0 ? excess / max(excess + back_amount * (1.0 - opacity), 1e-6) : 0.0;
    float coc = mix(centre_coc, front.coc / max(front_amount, 1e-6), share);
    return Light(light, coc);
}

Light blur(usampler2D image, ivec2 p, float near_px, Line line) {
    Light centre = unpack_light(texelFetch(image, p, 0));
#if WEIGHTS == WEIGHTS_SEED
    near_px = 0.0;  // the listing gathers by the centre's CoC alone
#endif
    float extent_px = max(abs(centre.coc), near_px);
    if (extent_px < 0.5) return centre;

    ivec2 last = textureSize(image, 0) - 1;
    float half_length_px = line.major * extent_px;
    float step_px = 1.0;
    int limit = tap_limit(extent_px);
    int count = max(int(ceil(half_length_px - 0.5 - 1e-4)), 0);
    if (count > limit) {
        count = limit;
        step_px = half_length_px / (float(limit) + 0.5);
    }

    Sum front = Sum(vec4(0.0), 0.0, 0.0), back = Sum(vec4(0.0), 0.0, 0.0);
    // Loops that test at their end: llvmpipe runs the body of the others once more, with every pixel masked. A slab
    // touches at least one texel.
    int k = -count;
    do {
        float along = floor(float(k) * step_px + 0.5);
        float middle = along * line.slope;
        float low = middle - 0.5 * line.width, high = middle + 0.5 * line.width;
        float own_cover = cover(line.major * abs(centre.coc), abs(along), step_px);
        int j = int(floor(low + 0.501)), last_j = int(ceil(high - 0.501));
        do {
            float across = (min(float(j) + 0.5, high) - max(float(j) - 0.5, low)) / line.width;
            ivec2 offset = line.x_major ? ivec2(int(along), j) : ivec2(j, int(along));
            Light tap = unpack_light(texelFetch(image, clamp(p + offset, ivec2(0), last), 0));
            add_tap(front, back, tap, centre.coc, across, own_cover, abs(along), line.major, step_px);
        } while (++j <= last_j);
    } while (++k <= count);
    return combine_sums(front, back, centre.coc);
}
