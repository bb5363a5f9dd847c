// The directions of the 1-D blurs, and how a line crosses the pixel grid.
//
// Taps step whole pixels along the line's major axis and take, across it, every texel that a slab around the line touches,
// by the length it touches. Bilinear taps at even distances along a diagonal ripple: they lose up to 9 % of a point's
// energy, and mix the CoC of both sides of a silhouette.
struct Line {
    bool x_major;
    float major;  // px along the major axis for 1 px along the line
    float slope;  // px across for 1 px along the major axis
    float width;  // px of the slab
};

Line make_line(float degrees) {
    float angle = radians(degrees);
    float c = cos(angle), s = sin(angle);
    Line line;
    line.x_major = abs(c) >= abs(s) - 1e-4;
    line.major = max(abs(c), abs(s));
    line.slope = line.x_major ? s / c : c / s;
    if (abs(line.slope) < 1e-5) line.slope = 0.0;
    line.width = 1.0;
    return line;
}

vec2 line_step(Line line) { return line.x_major ? vec2(1.0, line.slope) : vec2(line.slope, 1.0); }

// How wide the first slab must be for the lattice of two directions to have no holes: the area of its cell.
float slab_width(Line first, Line second) {
    vec2 u = line_step(first), v = line_step(second);
    return clamp(abs(u.x * v.y - u.y * v.x), 1.0, 2.0);
}

// Half the length of a parallelogram's side over the CoC radius, which is the polygon's circumradius.
#if SHAPE == SHAPE_HEXAGON
const float kSide = 1.0;
#elif SHAPE == SHAPE_OCTAGON
const float kSide = 0.92387953;  // cos 22.5 deg
#elif SHAPE == SHAPE_SQUARE
const float kSide = 0.70710678;  // 1 / sqrt 2
#else
#define kSide (0.5 / cos(radians(45.0 - 0.5 * abs(param.skew))))  // the longer diagonal is 2 R
#endif

// Direction of the first blur, deg, and those of the second blurs. A hexagon with an edge's middle at +x is the
// intersection of two parallelograms out of the directions 90, 30 and 150 deg; the one nearest to an axis is shared,
// because a first blur along a diagonal would need a slab two texels wide.
#if SHAPE == SHAPE_HEXAGON
float first_degrees() {
    float best = 90.0 + param.rotation, most = 0.0;
    for (int i = 0; i < 3; ++i) {
        float degrees = 90.0 + param.rotation - 60.0 * float(i);
        float major = make_line(degrees).major;
        if (major > most + 1e-5) {
            most = major;
            best = degrees;
        }
    }
    return best;
}
float second_degrees(int parallelogram) { return first_degrees() + (parallelogram == 0 ? -60.0 : 60.0); }
#elif SHAPE == SHAPE_PARALLELOGRAM
float first_degrees() { return param.rotation; }
float second_degrees(int parallelogram) { return param.rotation + 90.0 - param.skew; }
#else
float first_degrees() { return param.rotation; }
float second_degrees(int parallelogram) { return param.rotation + 90.0; }
#endif
