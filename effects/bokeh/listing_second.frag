#version 450 core
#include <pass>
#include "combine.glsl"
#include "listing.glsl"

void main() {
    out_color = listing_blur(line_a, second_degrees(0));
#if SHAPE == SHAPE_HEXAGON
    out_color = combine(out_color, listing_blur(line_a, second_degrees(1)));
#elif defined(HAS_LINE_B)
    out_color = combine(out_color, listing_blur(line_b, second_degrees(1)));
#endif
}
