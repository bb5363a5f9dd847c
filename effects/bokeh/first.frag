#version 450 core
#include <pass>
#include "blur.glsl"

Line first_line(float degrees, float second_a, float second_b) {
    Line line = make_line(degrees);
    line.width = max(slab_width(line, make_line(second_a)), slab_width(line, make_line(second_b)));
    return line;
}

void main() {
    ivec2 p = ivec2(gl_FragCoord.xy);
    float near_px = texelFetch(near, p / kTile, 0).r;
    Line line = first_line(first_degrees(), second_degrees(0), second_degrees(1));
    out_first_a = pack_light(blur(light, p, near_px, line));
#if SHAPE == SHAPE_OCTAGON
    Line turned = first_line(first_degrees() + 45.0, second_degrees(0) + 45.0, second_degrees(1) + 45.0);
    out_first_b = pack_light(blur(light, p, near_px, turned));
#endif
}
