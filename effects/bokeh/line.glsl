// How a line of the outline crosses the pixel grid.
//
// Taps step whole pixels along the line's major axis and take, across it, every texel that a slab around the line touches,
// by the length it touches. Bilinear taps at even distances along a diagonal ripple: they lose up to 9 % of a point's
// energy, and mix the CoC of both sides of a silhouette.
#include "outline.glsl"

struct Line {
    bool x_major;
    float major;  // px along the major axis for 1 px of CoC radius
    float slope;  // px across for 1 px along the major axis
    float width;  // px of the slab
};

Line make_line(float degrees) {
    vec2 along = squeezed(direction(degrees));
    Line line;
    line.x_major = abs(along.x) >= abs(along.y) - 1e-4;
    line.major = half_side() * max(abs(along.x), abs(along.y));
    line.slope = line.x_major ? along.y / along.x : along.x / along.y;
    if (abs(line.slope) < 1e-5) line.slope = 0.0;
    line.width = 1.0;
    return line;
}

vec2 line_step(Line line) { return line.x_major ? vec2(1.0, line.slope) : vec2(line.slope, 1.0); }

// How wide the first slab must be for the lattice of two directions to have no holes: the area of its cell.
float slab_width(Line first, Line second) {
    return clamp(abs(crossed(line_step(first), line_step(second))), 1.0, 2.0);
}

Line first_line(int parallelogram) {
    Line line = make_line(first_degrees(parallelogram));
#if SHAPE == SHAPE_HEXAGON
    // Shared by both, which a loop takes, as shared_degrees() does.
    int i = param.squeeze < 0.0 ? 1 : 0;
    do {
        line.width = max(line.width, slab_width(line, make_line(second_degrees(i))));
    } while (++i < 2);
#else
    line.width = slab_width(line, make_line(second_degrees(parallelogram)));
#endif
    return line;
}

// From the vertex shader, which computes a line once, to the pixels.
vec4 packed_line(Line line) { return vec4(line.x_major ? 1.0 : 0.0, line.major, line.slope, line.width); }
Line unpacked_line(vec4 line) { return Line(line.x > 0.5, line.y, line.z, line.w); }

Line second_line(int parallelogram) { return make_line(second_degrees(parallelogram)); }
