// Where grains lie: at whole places of a grid on the display window.

vec2 grain_place(ivec2 p) { return vec2(p + frame.origin) / max(param.size, 1.0); }

ivec2 nearest_grain(ivec2 p) { return ivec2(floor(grain_place(p) + 0.5)); }

// The first and the last that a pixel takes. Texel (0, 0) of the textures holds the first one. Grains wider than a pixel are fewer
// than pixels; those of a pixel's width are two more each way, for which the textures are a quarter wider than the picture.
// The effect's reach of 4 px keeps the parts that regions render wide enough for that.
ivec2 first_grain() { return nearest_grain(ivec2(0)) - 1; }
ivec2 last_grain() { return nearest_grain(frame.size - 1) + 1; }
