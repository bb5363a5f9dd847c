#version 450 core
#include <pass>
#include <aperture.glsl>
#include "picture.glsl"

const int kSide = 32;

void main() {
    Aperture a = make_aperture(param.blades, param.curvature, radians(param.rotation));
    float sum = 0.0, count = 0.0;
    for (int y = 0; y < kSide; ++y)
        for (int x = 0; x < kSide; ++x) {
            vec2 point = (vec2(x, y) + 0.5) * 2.0 / float(kSide) - 1.0;
            if (aperture_gauge(a, point) > 1.0) continue;
            sum += passes_at(point);
            count += 1.0;
        }
    out_passes_mean = sum / max(count, 1.0);
}
