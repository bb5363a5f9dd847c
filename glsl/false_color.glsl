// Data as colours, encoded for the display: the same as framework/image/false_color.h makes.
#include <false_color_tables.glsl>

vec3 color_of_stop(int rgb) { return vec3((rgb >> 16) & 255, (rgb >> 8) & 255, rgb & 255) / 255.0; }

// From dark to bright, t in 0..1.
vec3 ramp_color(float t) {
    const int stops[] = int[](FALSE_COLOR_RAMP);
    float at = clamp(t, 0.0, 1.0) * float(stops.length() - 1);
    int stop = min(int(at), stops.length() - 2);
    return mix(color_of_stop(stops[stop]), color_of_stop(stops[stop + 1]), at - float(stop));
}

// Signed values t in -1..1: blue below 0, white at 0, red above.
vec3 diverging_color(float t) {
    const int stops[] = int[](FALSE_COLOR_DIVERGING);
    float at = (clamp(t, -1.0, 1.0) * 0.5 + 0.5) * float(stops.length() - 1);
    int stop = min(int(at), stops.length() - 2);
    return mix(color_of_stop(stops[stop]), color_of_stop(stops[stop + 1]), at - float(stop));
}

// Red at 0 turns, then, as y points down, magenta, blue, green.
vec3 hue_color(float turns, float saturation, float value) {
    vec3 k = abs(fract(turns + vec3(3.0, 1.0, 2.0) / 3.0) * 6.0 - 3.0) - 1.0;
    return value * (1.0 + saturation * (clamp(k, 0.0, 1.0) - 1.0));
}

// Direction (+x right, +y down) as hue, length 0..1 from black to the full colour by its square root; longer vectors turn
// paler.
vec3 wheel_color(vec2 v) {
    float length_ = length(v);
    if (!(length_ > 0.0)) return vec3(0.0);
    return hue_color(atan(v.y, v.x) / 6.28318530718, length_ > 1.0 ? 1.0 / length_ : 1.0, sqrt(min(length_, 1.0)));
}

// Neighbouring ids get hues far apart: multiples of the golden ratio (Knuth, TAOCP 3, 6.4). 0 is black.
vec3 id_color(uint id) {
    if (id == 0u) return vec3(0.0);
    uint hash = id * 2654435769u;
    return hue_color(float(hash) / 4294967296.0, (hash & 64u) != 0u ? 0.55 : 0.85, (hash & 128u) != 0u ? 0.95 : 0.7);
}
