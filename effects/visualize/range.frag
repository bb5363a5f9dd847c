#version 450 core
#include <pass>
#include <text.glsl>
#include "mode.glsl"

// The least of 1, 2 and 5 times a power of ten that is no less than a value above 0.
float round_end(float value) {
    float power = power_of_ten(decimal_exponent(value)), most = value * 0.999999;
    return power * (most <= 1.0 * power ? 1.0 : most <= 2.0 * power ? 2.0 : most <= 5.0 * power ? 5.0 : 10.0);
}

void main() {
    vec2 range = vec2(3e38, -3e38);
    int faults = 0;
    for (int i = 0; i < 64; ++i) {
        vec4 strip = texelFetch(range_strip, ivec2(i, 0), 0);
        range = vec2(min(range.x, strip.x), max(range.y, strip.y));
        faults |= int(strip.z);
    }
    float largest = clamp(range.y, 0.0, 1e37);
    float automatic = largest > 1e-30 ? round_end(largest) : 1.0;
#if SHOW == SHOW_DEPTH
    bool any_hit = range.y >= range.x;
    vec2 ends = vec2(param.near > 0.0 ? param.near : any_hit ? range.x : 1.0, param.far > 0.0 ? param.far : any_hit ? range.y : 1.0);
#elif SHOW == SHOW_SCALAR
    vec2 ends = param.low == param.high ? vec2(0.0, automatic) : vec2(param.low, param.high);
#else
    float end = param.max > 0.0 ? param.max : automatic;
    vec2 ends = vec2(SHOW == SHOW_SIGNED ? -end : 0.0, end);
#endif
    out_range = vec4(ends, float(faults), 0.0);
}
