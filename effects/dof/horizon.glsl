// The CoC where a round surface ends. Within its last pixel the distance changes faster than anywhere else, and the pixel's middle lies
// nearer than the end, so that a narrow blur would be too wide there.
#include <lens/highlight.glsl>

float coc_inside(ivec2 p) { return texelFetch(lit_coc, clamp(p, ivec2(0), frame.size - 1), 0).r; }

const float kNarrowPx = 3.0;  // a wider blur hides where its surface ends
const float kRound = 0.05;    // error of the fourth pixel's CoC, of the step between the first two
// Of the steps between three pixels: at most 0.77 beside the end of a round surface, and 1 on a plane but for rounding.
const float kStraight = 0.85;

// Along a circle's or a sphere's outline (c - end)^2 is linear in the distance from the outline: three pixels give `end`, and a fourth
// tells a round surface from others.
float horizon_coc(ivec2 p, float coc_px) {
    // As in unmix.glsl, each pixel takes its own sides in turn.
    uint sides = 0u;
    for (int i = abs(coc_px) < kNarrowPx ? 1 : 9; i < 9; i += 2)
        if (coc_inside(p + ivec2(i % 3, i / 3) - 1) > coc_px + kOneSurfacePx) sides |= 1u << i;
    float sum = 0.0, count = 0.0;
    for (; sides != 0u; sides &= sides - 1u) {
        int i = findLSB(sides);
        ivec2 to = ivec2(i % 3, i / 3) - 1;
        float second = coc_inside(p - to), third = coc_inside(p - 2 * to);
        float step_px = coc_px - second, next_px = second - third;
        if (next_px <= 0.0 || next_px > kStraight * step_px || step_px > kOneSurfacePx) continue;
        float end = (2.0 * second * second - coc_px * coc_px - third * third) / (2.0 * (next_px - step_px));
        float off = (second - end) * (second - end), slope = off - (coc_px - end) * (coc_px - end);
        float fourth = end - sqrt(max(off + 2.0 * slope, 0.0));
        if (abs(fourth - coc_inside(p - 3 * to)) > kRound * step_px) continue;
        sum += clamp(end - coc_px, 0.0, 2.0 * step_px);
        count += 1.0;
    }
    return coc_px + clamp(kNarrowPx - abs(coc_px), 0.0, 1.0) * sum / max(count, 1.0);
}
