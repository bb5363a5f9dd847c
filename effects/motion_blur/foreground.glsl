// What a lens has spread over a pixel from in front of what it shows.
ivec2 within(ivec2 p) { return clamp(p, ivec2(0), frame.size - 1); }

vec4 places_at(ivec2 p) { return texelFetch(foreground_place, p, 0); }

// The pixel that most of the light comes from.
ivec2 sender_of(ivec2 p) { return within(p + ivec2(round(places_at(p).xy))); }

// A pixel of the surface that the light covers: where that is not what the depth shows, one beside it.
ivec2 covered_by_light(ivec2 p) { return within(p + ivec2(round(places_at(p).zw))); }

// What covers need not be opaque in the picture's alpha, of which light in front has no more than there is.
float alpha_of_light(float opacity, float alpha) { return min(opacity, alpha); }
