#version 450 core
#include <pass>
#include <aperture.glsl>

const int kRows = 4096;  // width of `edge`
const int kSteps = 26;

// The outline for a radius of 1 in the middle of a row: its left and right end, and 1, or nothing where the row misses it.
// The gauge is convex along the row: its least place lies inside if anything does.
void main() {
    Aperture aperture = make_aperture(param.blades, param.curvature, radians(param.rotation));
    float y = 2.0 * gl_FragCoord.x / float(kRows) - 1.0;
    float low = -1.0, high = 1.0;
    for (int i = 0; i < 2 * kSteps; ++i) {
        float a = mix(low, high, 0.375), b = mix(low, high, 0.625);
        if (aperture_gauge(aperture, vec2(a, y)) < aperture_gauge(aperture, vec2(b, y))) high = b;
        else low = a;
    }
    vec2 inside = vec2(0.5 * (low + high)), outside = vec2(-1.0, 1.0);
    out_edge = vec4(0.0);
    if (aperture_gauge(aperture, vec2(inside.x, y)) > 1.0) return;
    for (int i = 0; i < kSteps; ++i)
        for (int side = 0; side < 2; ++side) {
            float x = 0.5 * (inside[side] + outside[side]);
            if (aperture_gauge(aperture, vec2(x, y)) <= 1.0) inside[side] = x;
            else outside[side] = x;
        }
    out_edge = vec4(inside, 1.0, 0.0);
}
