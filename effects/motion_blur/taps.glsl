// When a pixel looks, and where.
#include <shutter/random_phase.glsl>
#include "packed_motion.glsl"

// How far this pixel's times are moved, in their distance: nothing where they leave out no px.
float tap_shift(float apart_px) { return (random_phase() - 0.5) * param.jitter * clamp(apart_px - 1.0, 0.0, 1.0); }

float time_shift(vec4 path, int taps) { return tap_shift(sweep_px(path) / float(taps)); }

// The exposure in parts, cut where a path crosses borders of texels, along the axis where its sweep is longer: a look-up between two of them
// has the mean of both texels. Part i goes from first_px + i step_px to the next, within 0 and length_px.
struct Parts {
    float length_px, first_px, step_px, shift_px;
    float each_px;  // exposures
};

Parts parts_of(vec4 path, int most) {
    vec2 sweep = path.xy + path.zw * (kOpens + kCloses), opens = way_px(path, kOpens);
    bool is_level = abs(sweep.x) >= abs(sweep.y);
    float along = is_level ? sweep.x : sweep.y, start = is_level ? opens.x : opens.y;
    float length_px = max(abs(along), 1e-3), step_px = max(1.0, length_px / float(most - 1));
    return Parts(length_px, -fract(0.5 + (along < 0.0 ? -start : start)), step_px, tap_shift(step_px) * step_px, 1.0 / length_px);
}

// In the exposure: where a path turns round, its sweep is short and little beyond it leads far away.
float part_time(Parts parts, float place_px) {
    return kOpens + (clamp(place_px, 0.0, parts.length_px) + parts.shift_px) * parts.each_px;
}

float tap_time(int i, float shift, int taps) { return kOpens + (float(i) + 0.5 + shift) / float(taps); }

#ifdef VEILED
#define picture clean
#else
#define picture color
#endif

// Software GL loads a uniform lane by lane wherever it is named, but divides only here, before all loops.
vec2 picture_px = 1.0 / vec2(frame.size);

vec4 color_at(vec2 point) { return textureLod(picture, point * picture_px, 0.0); }

// The conversion rounds down, as nothing is below 0 here.
ivec2 texel_at(vec2 point) { return ivec2(clamp(point, vec2(0.0), vec2(frame.size - 1))); }

float depth_at(vec2 point) { return depth_of(texel_at(point)); }

Motion motion_at(vec2 point) { return packed_motion(texel_at(point)); }
