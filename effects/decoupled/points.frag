#version 450 core
#include <pass>
#include <aperture.glsl>
#include "path.glsl"

int common_divisor(int a, int b) {
    while (b != 0) {
        int rest = a % b;
        a = b;
        b = rest;
    }
    return a;
}

// Points of the lens lie on Vogel's spiral (Vogel 1979), which fills it evenly with any number of points; their times are van der
// Corput's sequence: samples beside each other on the lens are far apart in time. Leaping along the spiral by about the golden
// section makes the points of any band of samples fill the lens.
void main() {
    int number = int(gl_FragCoord.x), leap = int(0.618034 * float(param.samples));
    while (common_divisor(leap, param.samples) != 1) ++leap;
    float along = float(number * leap % param.samples), angle = 2.399963229728653 * along;
    Aperture aperture = make_aperture(param.blades, param.curvature, radians(param.rotation));
    vec2 point = aperture_from_disk(aperture, sqrt((along + 0.5) / float(param.samples)) * vec2(cos(angle), sin(angle)));
    float part = float(bitfieldReverse(uint(number)) >> 8u) * (1.0 / 16777216.0) + 0.5 / float(param.samples);
    out_points = vec4(point, kOpens + min(part, 1.0), 0.0);
}
