// Where pixels are on their surfaces. Needs the textures surface and facet.
#include <scattering/lines.glsl>

// 0 where nothing scatters, else the same for all pixels that light goes between.
uint key_at(ivec2 pixel) { return texelFetch(facet, pixel, 0).r; }

vec3 place_mm(vec2 pixel, float depth_m) { return view_position(view_lines(), pixel, depth_m); }

vec3 place_mm(ivec2 pixel) { return place_mm(vec2(pixel) + 0.5, texelFetch(surface, pixel, 0).a); }
