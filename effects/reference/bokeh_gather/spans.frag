#version 450 core
#include <pass>
#include <aperture.glsl>

// Slightly outside, so that a pixel that the outline halves counts as covered, whatever rounding does.
const float kOutline = 1.00002;
const int kSteps = 24;  // each halves the error, or leaves 2/3 of it

// The outline is convex, and so is its gauge along a line: `along` of the least one on start + along * direction.
float nearest_the_middle(Aperture a, vec2 start, vec2 direction) {
    float low = -1.0, high = 1.0;
    for (int i = 0; i < kSteps; ++i) {
        float third = (high - low) / 3.0;
        bool left = aperture_gauge(a, start + (low + third) * direction) < aperture_gauge(a, start + (high - third) * direction);
        if (left) high -= third;
        else low += third;
    }
    return 0.5 * (low + high);
}

// Where the line leaves the outline, from an `along` inside to one outside.
float leaves(Aperture a, vec2 start, vec2 direction, float inside, float outside) {
    for (int i = 0; i < kSteps; ++i) {
        float middle = 0.5 * (inside + outside);
        if (aperture_gauge(a, start + middle * direction) <= kOutline) inside = middle;
        else outside = middle;
    }
    return 0.5 * (inside + outside);
}

// How far the outline goes towards +y (sign 1) or -y (-1): the highest row that it still reaches.
float highest(Aperture a, float sign) {
    float inside = 0.0, outside = 1.0;
    for (int i = 0; i < kSteps; ++i) {
        float y = 0.5 * (inside + outside);
        vec2 row = vec2(0.0, sign * y);
        if (aperture_gauge(a, row + vec2(nearest_the_middle(a, row, vec2(1.0, 0.0)), 0.0)) <= kOutline) inside = y;
        else outside = y;
    }
    return sign * outside;
}

void main() {
    Aperture a = make_aperture(param.blades, param.curvature, radians(param.rotation));
    float lowest_y = highest(a, -1.0), highest_y = highest(a, 1.0);
    vec2 row = vec2(0.0, clamp(gl_FragCoord.x / 512.0 - 1.0, lowest_y, highest_y)), across = vec2(1.0, 0.0);
    float middle = nearest_the_middle(a, row, across);
    out_spans = vec4(leaves(a, row, across, middle, -1.01), leaves(a, row, across, middle, 1.01), lowest_y, highest_y);
}
