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

// Maps the unit disk onto the aperture so that equal areas stay equal where its blades are straight: a blade's part of the disk
// becomes the triangle of its edge.
vec2 onto_aperture(Aperture a, float radius, float turn) {
    float angle = 2.0 * kPi * turn;
    if (a.blades > 0.0) {
        float blade = 2.0 * kPi / a.blades, number = floor(turn * a.blades), part = turn * a.blades - number;
        float half_edge = tan(0.5 * blade);
        angle = a.rotation_rad + number * blade + atan(mix(-half_edge, half_edge, part));
    }
    return radius * aperture_outline(a, angle) * vec2(cos(angle), sin(angle));
}

// Points of the lens lie on Vogel's spiral (Vogel 1979), which fills it evenly with any number of points; their times are van der
// Corput's sequence: samples beside each other on the lens are far apart in time. Leaping along the spiral by about the golden
// section makes the points of any band of samples fill the lens.
void main() {
    int number = int(gl_FragCoord.x), leap = int(0.618034 * float(param.samples));
    while (common_divisor(leap, param.samples) != 1) ++leap;
    float along = float(number * leap % param.samples);
    Aperture aperture = make_aperture(param.blades, param.curvature, radians(param.rotation));
    vec2 point = onto_aperture(aperture, sqrt((along + 0.5) / float(param.samples)), fract(0.38196601 * along));
    float part = float(bitfieldReverse(uint(number)) >> 8u) * (1.0 / 16777216.0) + 0.5 / float(param.samples);
    out_points = vec4(point, kOpens + min(part, 1.0), 0.0);
}
