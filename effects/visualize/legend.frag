#version 450 core
#include <pass>
#include "arrow.glsl"
#include "faults.glsl"
#include "layout.glsl"

layout(location = 0) flat in ivec2 corner;

const vec3 kPaper = vec3(0.07);

#if SHOW == SHOW_NORMAL || SHOW == SHOW_OBJECT_ID
vec3 cell_color(int cell) {
#if SHOW == SHOW_OBJECT_ID
    return id_color(uint(cell));
#else
    vec3 n = vec3(0.0);
    n[cell / 2] = cell % 2 == 0 ? 1.0 : -1.0;
    return n * 0.5 + 0.5;
#endif
}
#endif

vec3 bar_color(float t) {
#if SHOW == SHOW_NORMAL || SHOW == SHOW_OBJECT_ID
    return cell_color(min(int(t * float(kCells)), kCells - 1));
#elif SHOW == SHOW_DEPTH
    return ramp_color(1.0 - t);
#elif SHOW == SHOW_SIGNED
    return diverging_color(2.0 * t - 1.0);
#else
    return ramp_color(t);
#endif
}

// `u` in units from the panel's corner.
vec3 drawing(vec2 u, float px_per_unit) {
#if SHOW == SHOW_VELOCITY || SHOW == SHOW_TILES
    vec2 offset = u - vec2(0.5 * float(kBody.x), kTitleHeight + kWheelRadius);
    float cover = clamp((float(kWheelRadius) - length(offset)) * px_per_unit + 0.5, 0.0, 1.0);
    return mix(kPaper, wheel_color(offset / float(kWheelRadius)), cover);
#elif SHOW == SHOW_ARROWS
    vec2 tail = vec2(8.0, kTitleHeight + 4) * px_per_unit;
    float length_px = min(key_velocity(int(px_per_unit)) * param.scale, 64.0 * px_per_unit);
    Arrow key = Arrow(tail, vec2(length_px, 0.0), 1.5 * px_per_unit);
    return mix(kPaper, wheel_color(vec2(1.0, 0.0)), arrow_cover(key, u * px_per_unit));
#elif SHOW == SHOW_LIGHT
    return kPaper;
#else
    float t = (u.x - float(kBarLeft)) / float(kBarRight - kBarLeft);
    bool in_bar = t >= 0.0 && t < 1.0 && u.y >= float(kTitleHeight) && u.y < float(kBarBottom);
    bool in_ticks = kCells == 0 && u.y >= float(kBarBottom) && u.y < float(kBarBottom + 3);
    // Five ticks, one unit wide, the outer ones at the ends of the bar.
    float tick = fract((u.x - float(kBarLeft)) / (0.25 * float(kBarRight - kBarLeft - 1))) * 0.25 * float(kBarRight - kBarLeft - 1);
    bool on_tick = in_ticks && t >= 0.0 && t < 1.0 && tick < 1.0;
    return in_bar ? bar_color(t) : on_tick ? vec3(0.8) : kPaper;
#endif
}

void main() {
    vec2 px = gl_FragCoord.xy - vec2(corner), u = px / float(unit_px());
    vec3 result = drawing(u, float(unit_px()));
    // Squares of the loud colours that the picture has.
    int faults = int(texelFetch(range, ivec2(0), 0).z);
    vec2 row = u - vec2(6.0, kBody.y);
    int fault = int(floor(row.x / 29.0));
    bool in_square = fault >= 0 && fault < 4 && row.x - 29.0 * float(fault) < 7.0 && row.y >= 0.0 && row.y < 7.0;
    // From the right of the code: NaN, infinity, below 0, nothing hit.
    int bit = fault == 0 ? kNan : fault == 1 ? kInfinite : fault == 2 ? kNegative : kNothingHit;
    if (in_square && (faults & bit) != 0) result = fault_color(bit);
    out_display = vec4(result, 1.0);
}
