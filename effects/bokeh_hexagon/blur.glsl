// One-sided blurs from grid point to grid point that spread every point by its own circle of confusion.
#include <lens/highlight.glsl>
#include "tile.glsl"
#include "grid.glsl"
#include "sample.glsl"

const float kSharpPx = 1.0;  // the light of a point with a smaller CoC is its own

// Light gathered from one side of the centre.
struct Sum {
    vec4 light;     // premultiplied RGB, alpha
    float weight;
    float covered;  // weight as it would be with every sample's at 1
    float opacity;  // times weight
    float coc;      // times weight and amount of light
};

// How much of step `step` lies within `reach` steps of one end of the line: half of the first, which other lines share.
float cover(float reach, int step) { return step == 0 ? min(reach, 0.5) : clamp(reach - float(step) + 0.5, 0.0, 1.0); }

// `side` is the side of the centre, 1 or -1, on which the lens sees the tap if it is behind the focus plane or before it; a tap
// in front of the centre counts as far as its own CoC reaches, thinned by that length, the rest through the centre's aperture.
void add_tap(inout Sum front, inout Sum back, Sample tap, float centre_coc, float own_cover, int side, int step) {
    float in_front = step == 0 ? 0.0 : clamp(centre_coc - tap.coc, 0.0, 1.0);
    float back_cover = (1.0 - in_front) * own_cover, back_weight = back_cover * tap.weight;
    back.light += back_weight * tap.color;
    back.weight += back_weight;
    back.covered += back_cover;
    back.opacity += back_weight * tap.opacity;
    float reach = abs(tap.coc) / kSpacing;
    if (in_front == 0.0 || tap.coc * float(side) < 0.0 || reach < 0.5) return;
    float front_weight = in_front * cover(reach, step) / reach * tap.weight;
    front.light += front_weight * tap.color;
    front.weight += front_weight;
    front.coc += front_weight * amount(tap.color.rgb) * tap.coc;
}

#ifdef UNDER
// Splits a tap in focus into itself, which it leaves in `tap`, and what the first blur laid over it, which lies on the same line
// of sight as far as the near CoC reaches.
void take_off_what_is_over(inout Sum front, inout Sample tap, ivec2 texel, float near, int side, int step) {
    if (tap.opacity == 0.0 || near * kSpacing < kLeastBlurPx || abs(tap.coc) > kSharpPx) return;
    Sample sharp = unpack_sample(texelFetch(UNDER, texel, 0));
    vec4 under = sharp.weight > 0.0 ? sharp.color : tap.color;
    if (side < 0 || step == 0) {
        float weight = cover(near, step) / near * tap.weight;
        front.light += weight * (tap.color - (1.0 - tap.opacity) * under);
        front.weight += weight * tap.opacity;
    }
    tap.color = under;
    tap.opacity = 0.0;
}
#endif

// The front over the mean of the back. The result keeps the centre's CoC for the second blur, unless most of its light is a
// highlight in front, which then spreads on by the highlight's.
Sample combine_sums(Sum front, Sum back, Sample centre) {
    // A point outside the picture has no light of its own.
    vec4 behind = back.weight > 0.0 ? back.light / back.weight : front.light / max(front.weight, 1e-6);
    float opacity = min(front.weight, 1.0), seen = 1.0 - opacity;
    vec4 light = front.light / max(front.weight, 1.0) + behind * seen;

    float front_amount = amount(front.light.rgb), back_amount = amount(behind.rgb);
    float excess = max(front_amount - kHighlight * front.weight * back_amount, 0.0);
    float share = front_amount > 0.0 ? excess / max(excess + back_amount * seen, 1e-6) : 0.0;
    float coc = mix(centre.coc, front.coc / max(front_amount, 1e-6), share);
    float back_weight = back.weight / max(back.covered, 1e-6);
    float back_opacity = back.weight > 0.0 ? back.opacity / back.weight : centre.opacity;
    return Sample(light, coc, mix(back_weight, 1.0, opacity), opacity + seen * back_opacity);
}

// Blurs towards the corner of the hexagon that lies `direction` from its middle.
Sample blur(usampler2D image, Grid grid, ivec2 point, float near_px, ivec2 direction) {
    ivec2 size = textureSize(image, 0);
    Sample centre = unpack_sample(texelFetch(image, texel_of(grid, point), 0));
    // On the fine grid only what is near to coarsely blurred tiles has larger radii, and no tile needs to see further.
    float largest_px = FINE == 1 ? kCoarsePx : 1e6;
    float own = min(abs(centre.coc), largest_px) / kSpacing, near = min(near_px, largest_px) / kSpacing;
    if (max(own, near) * kSpacing < kLeastBlurPx) return centre;

    Sum front = Sum(vec4(0.0), 0.0, 0.0, 0.0, 0.0), back = front;
#ifdef UNDER
    Sample middle = centre;
    take_off_what_is_over(front, middle, texel_of(grid, point), near, 1, 0);
    add_tap(front, back, middle, centre.coc, 0.5, 1, 0);
#else
    add_tap(front, back, centre, centre.coc, 0.5, 1, 0);
#endif
    for (int side = -1; side <= 1; side += 2) {
        float own_reach = centre.coc * float(side) > 0.0 ? own : 0.0;
        float reach = max(own_reach, side < 0 ? near : 0.0);
        int steps = int(ceil(reach - 0.5));
        for (int step = 1; step <= steps; ++step) {
            ivec2 texel = texel_of(grid, point - side * step * direction);
            float own_cover = cover(own_reach, step);
            Sample tap = Sample(vec4(0.0), 0.0, 0.0, 0.0);
            if (is_in(texel, size)) tap = unpack_sample(texelFetch(image, texel, 0));
#ifdef UNDER
            take_off_what_is_over(front, tap, texel, near, side, step);
#endif
            if (tap.weight > 0.0) add_tap(front, back, tap, centre.coc, own_cover, side, step);
            else back.covered += own_cover;
        }
    }
    return combine_sums(front, back, centre);
}
