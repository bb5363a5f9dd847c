#version 450 core
#include <pass>

// cos^4 of the angle between the axis and the ray through a point of the sensor.
float natural_falloff(vec2 from_centre_px) {
    float mm_per_px = param.sensor_width / float(frame.display_size.x);
    vec2 tangent = from_centre_px * mm_per_px / param.focal_length;
    float cos_squared = 1.0 / (1.0 + dot(tangent, tangent));
    return cos_squared * cos_squared;
}

// 0 inside, 1 outside; both measures of distance are 1 in the corner.
float artistic_darkness(vec2 from_centre_px) {
    vec2 half_size_px = 0.5 * vec2(frame.display_size);
    float ellipse = length(from_centre_px / half_size_px) * sqrt(0.5);
    float circle = length(from_centre_px) / length(half_size_px);
    float distance_ = mix(ellipse, circle, param.roundness);
    float t = clamp((distance_ - param.radius) / max(param.softness, 1e-6) + 0.5, 0.0, 1.0);
    return t * t * (3.0 - 2.0 * t);
}

void main() {
    vec2 from_centre_px = gl_FragCoord.xy + vec2(frame.origin) - 0.5 * vec2(frame.display_size);
    float light = mix(1.0, natural_falloff(from_centre_px), param.natural);
    light *= 1.0 - param.strength * artistic_darkness(from_centre_px);
    out_color = vec4(color.rgb * light, color.a);
}
