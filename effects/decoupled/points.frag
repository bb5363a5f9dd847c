#version 450 core
#include <pass>
#include <aperture.glsl>
#include "path.glsl"

// Points of the lens lie on Vogel's spiral (Vogel 1979), which fills it evenly with any number of points; their times are van der
// Corput's sequence: samples beside each other on the lens are far apart in time.
void main() {
    float i = floor(gl_FragCoord.x), angle = 2.399963229728653 * i;
    Aperture aperture = make_aperture(param.blades, param.curvature, radians(param.rotation));
    vec2 point = aperture_from_disk(aperture, sqrt((i + 0.5) / float(param.samples)) * vec2(cos(angle), sin(angle)));
    float part = float(bitfieldReverse(uint(i)) >> 8u) * (1.0 / 16777216.0) + 0.5 / float(param.samples);
    out_points = vec4(point, kOpens + min(part, 1.0), 0.0);
}
