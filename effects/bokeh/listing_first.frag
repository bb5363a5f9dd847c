#version 450 core
#include <pass>
#include "listing.glsl"

void main() {
    out_line_a = listing_blur(color, first_degrees(0));
#ifdef HAS_OUT_LINE_B
    out_line_b = listing_blur(color, first_degrees(1));
#endif
}
