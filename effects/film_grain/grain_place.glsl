// Where grains lie: at whole places of a grid on the display window.

vec2 grain_place(ivec2 p) { return vec2(p + frame.origin) / max(param.size, 1.0); }

ivec2 nearest_grain(ivec2 p) { return ivec2(floor(grain_place(p) + 0.5)); }

// Which grain texel (0, 0) of `grains` holds: the first that a pixel takes. Grains wider than a pixel are fewer.
ivec2 first_grain() { return nearest_grain(ivec2(0)) - 1; }
