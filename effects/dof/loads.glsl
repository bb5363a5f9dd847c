// Texels as images give them: software GL calls a function for each texelFetch, for which it lays aside all that a loop holds in
// registers. For eight pixels a fetch in a loop takes it 13 ns and a load 4.
#include "taps.glsl"
#include "coarse.glsl"

Light tap_light(ivec2 texel) { return unpack_light(texelFetch(light, clamp(texel, ivec2(0), frame.size - 1), 0)); }
Light tap_level(ivec2 texel, Grid grid) { return unpack_light(texelFetch(light, clamp(texel, ivec2(0), grid.last) + grid.origin, 0)); }
