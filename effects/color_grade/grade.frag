#version 450 core
#include <pass>
#include <coverage.glsl>
#include <luminance.glsl>
#include <srgb.glsl>
#include "table.glsl"
#include "white_balance.glsl"

// Of the size of the value, so that light below 0, which wide gamuts have, keeps its sign.
vec3 power_of(vec3 v, vec3 exponent) { return sign(v) * pow(abs(v), exponent); }

vec3 cdl(vec3 v) {
    v = v * param.slope + param.offset;
#if RANGE == RANGE_CDL
    v = clamp(v, 0.0, 1.0);
#endif
    // Exponents of 1 are left out: pow() is not exact.
    bvec3 raised = bvec3(v.x > 0.0 && param.power.x != 1.0, v.y > 0.0 && param.power.y != 1.0,
                         v.z > 0.0 && param.power.z != 1.0);
    v = mix(v, pow(max(v, 1e-38), param.power), raised);
    if (param.saturation != 1.0) v = mix(vec3(luminance(v)), v, param.saturation);
#if RANGE == RANGE_CDL
    v = clamp(v, 0.0, 1.0);
#endif
    return v;
}

vec3 graded(vec3 light) {
    light *= exp2(param.exposure);
    if (param.temperature != kNeutralKelvin || param.tint != 0.0) {
        vec3 rec709 = frame.rec709_from_color * light;
        light = inverse(frame.rec709_from_color) * balanced(rec709, param.temperature, param.tint);
    }
    if (param.contrast != 1.0) light = param.pivot * power_of(light / param.pivot, vec3(param.contrast));
    light = cdl(light);
    if (param.lut_amount > 0.0) light = mix(light, through_table(light), param.lut_amount);
    return light;
}

// Then not even the division by alpha may touch a bit.
bool is_identity() {
    return param.exposure == 0.0 && param.temperature == kNeutralKelvin && param.tint == 0.0 && param.contrast == 1.0 &&
           param.slope == vec3(1.0) && param.offset == vec3(0.0) && param.power == vec3(1.0) && param.saturation == 1.0 &&
           RANGE == RANGE_SCENE && !has_table();
}

void main() {
    bool is_covered = has_coverage(color.a);
    // Light without coverage (glows, flames) is graded, but offset must not light up the empty background: a second turn
    // grades black. A branch would cost both on llvmpipe, and so would a loop that tests before its first turn.
    vec3 light = straight_light(color), result = vec3(0.0), before;
    int turn = 0;
    do {
        before = result;
        result = graded(light);
        light = vec3(0.0);
    } while (++turn < (is_covered ? 1 : 2));
    out_color = vec4(is_covered ? result * color.a : before - result, color.a);
    if (is_identity()) out_color = color;
}
