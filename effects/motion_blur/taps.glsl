// When a pixel looks, and where.
#include <shutter/random_phase.glsl>
#include "packed_motion.glsl"

// How far this pixel's times are moved, in their distance: nothing where they leave out no px.
float tap_shift(float apart_px) { return (random_phase() - 0.5) * param.jitter * clamp(apart_px - 1.0, 0.0, 1.0); }

float time_shift(vec4 path, int taps) { return tap_shift(sweep_px(path) / float(taps)); }

float tap_time(int i, float shift, int taps) { return kOpens + (float(i) + 0.5 + shift) / float(taps); }

vec4 color_at(vec2 point) { return textureLod(color, point * color_size.zw, 0.0); }

// The conversion rounds down, as nothing is below 0 here.
ivec2 texel_at(vec2 point) { return ivec2(clamp(point, vec2(0.0), vec2(frame.size - 1))); }

float depth_at(vec2 point) { return depth_of(texel_at(point)); }

Motion motion_at(vec2 point) { return packed_motion(texel_at(point)); }
