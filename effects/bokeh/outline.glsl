// Which parallelograms make the aperture: the directions of their sides, and how long those are.

// The bokeh's height over its width; the longer of the two keeps the CoC radius.
vec2 squeezed(vec2 v) { return v * vec2(min(1.0 / param.squeeze, 1.0), min(param.squeeze, 1.0)); }

vec2 direction(float degrees) { return vec2(cos(radians(degrees)), sin(radians(degrees))); }

float crossed(vec2 a, vec2 b) { return a.x * b.y - a.y * b.x; }

#if SHAPE == SHAPE_CUSTOM
// Two parallelograms with half sides of 1 are the slabs |cross(side, x)| <= reach across their four sides.
struct Outline {
    float radius;  // of the circle around it
    float energy;  // of a point's light that combining keeps
};

Outline make_outline() {
    vec2 sides[4] = vec2[](direction(param.first_angle), direction(param.second_angle), direction(param.third_angle),
                           direction(param.fourth_angle));
    float area[2] = float[](abs(crossed(sides[0], sides[1])), abs(crossed(sides[2], sides[3])));  // a quarter of it
#if COMBINE == COMBINE_MIN
    // The part of each slab's edge that all other slabs contain. An edge and the middle span its share of the area.
    float around = 0.0, within = 0.0;
    for (int i = 0; i < 4; ++i) {
        float reach = area[i / 2], from = -1e3, to = 1e3;
        vec2 across = vec2(-sides[i].y, sides[i].x);
        for (int j = 0; j < 4; ++j) {
            if (j == i) continue;
            float other_reach = area[j / 2];
            float slope = crossed(sides[j], sides[i]), start = dot(vec2(-sides[j].y, sides[j].x), reach * across);
            if (abs(slope) < 1e-4) {  // parallel: the narrower of the two counts, or the first of equals
                bool hidden = other_reach < reach - 1e-5 || (other_reach < reach + 1e-5 && j < i);
                if (hidden) to = from;
            } else {
                float a = (-other_reach - start) / slope, b = (other_reach - start) / slope;
                from = max(from, min(a, b));
                to = min(to, max(a, b));
            }
        }
        if (to <= from) continue;
        around = max(around, length(vec2(reach, max(abs(from), abs(to)))));
        within += reach * (to - from);
    }
    return Outline(around, within / max(4.0 * max(area[0], area[1]), 1e-6));
#else
    float around = 0.0;
    for (int i = 0; i < 4; i += 2)
        around = max(around, max(length(sides[i] + sides[i + 1]), length(sides[i] - sides[i + 1])));
    return Outline(around, 1.0);
#endif
}

Outline g_outline = make_outline();  // once, not for every line

// Half the length of a side over the CoC radius, which is the outline's circumradius; but no line is longer than its
// diameter.
float half_side() { return 1.0 / max(g_outline.radius, 1.0); }
float kept_energy() { return clamp(g_outline.energy, 0.1, 1.0); }
#else
float half_side() {
#if SHAPE == SHAPE_HEXAGON
    return 1.0;
#elif SHAPE == SHAPE_OCTAGON
    return 0.92387953;  // cos 22.5 deg
#elif SHAPE == SHAPE_SQUARE
    return 0.70710678;  // 1 / sqrt 2
#else
    return 0.5 / cos(radians(45.0 - 0.5 * abs(param.skew)));  // the longer diagonal is 2 R
#endif
}

// Of an isolated point's light, what the minimum of the parallelograms keeps: the ratio of the areas.
float kept_energy() {
#if COMBINE == COMBINE_MIN && SHAPE == SHAPE_HEXAGON
    return 0.75;
#elif COMBINE == COMBINE_MIN && SHAPE == SHAPE_OCTAGON
    return 0.82842712;  // 2 (sqrt 2 - 1)
#else
    return 1.0;
#endif
}
#endif

// Two parallelograms: their first directions, and their second ones, deg. A hexagon with an edge's middle at +x is the
// intersection of two parallelograms out of the directions 90, 30 and 150 deg; the one nearest to an axis is shared,
// because a first blur along a diagonal would need a slab two texels wide.
#if SHAPE == SHAPE_HEXAGON
float shared_degrees() {
    float best = 90.0 + param.rotation, least = 2.0;
    int i = param.squeeze < 0.0 ? 1 : 0;  // 0, but no compiler knows: unrolled, this takes three times as long to compile
    do {
        float degrees = 90.0 + param.rotation - 60.0 * float(i);
        vec2 along = abs(squeezed(direction(degrees)));
        float slope = min(along.x, along.y) / max(along.x, along.y);
        if (slope < least - 1e-5) {
            least = slope;
            best = degrees;
        }
    } while (++i < 3);
    return best;
}

float g_shared_degrees = shared_degrees();  // once, not for every line
#endif

float first_degrees(int parallelogram) {
#if SHAPE == SHAPE_HEXAGON
    return g_shared_degrees;
#elif SHAPE == SHAPE_CUSTOM
    return param.rotation + (parallelogram == 0 ? param.first_angle : param.third_angle);
#else
    return param.rotation + (parallelogram == 0 ? 0.0 : 45.0);
#endif
}

float second_degrees(int parallelogram) {
#if SHAPE == SHAPE_HEXAGON
    return first_degrees(0) + (parallelogram == 0 ? -60.0 : 60.0);
#elif SHAPE == SHAPE_CUSTOM
    return param.rotation + (parallelogram == 0 ? param.second_angle : param.fourth_angle);
#elif SHAPE == SHAPE_PARALLELOGRAM
    return param.rotation + 90.0 - param.skew;
#else
    return first_degrees(parallelogram) + 90.0;
#endif
}
