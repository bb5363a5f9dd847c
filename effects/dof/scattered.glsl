// A highlight at one pixel of its disc.
#include "outline.glsl"

layout(location = 0) flat in vec2 source;
layout(location = 1) flat in vec3 light_of_source;
layout(location = 2) flat in float source_coc;

struct Scattered {
    float in_front, behind;  // of the surface that the pixel shows; the rest lies at its depth
    float density;           // share of the highlight's light that the disc has at the pixel
};

Scattered scattered_at(ivec2 p) {
    prepare_outline_at(source);
    float pixel_coc = texelFetch(lit_coc, p, 0).r, radius_px = abs(source_coc);
    float density = cover(radius_px, gauge(vec2(p) + 0.5 - source, source_coc)) / spread_area(radius_px);
    return Scattered(clamp(pixel_coc - source_coc, 0.0, 1.0), clamp(source_coc - pixel_coc, 0.0, 1.0), density);
}

// The share that is seen of light in front of what the pixel shows, or at its depth; `seen`: of light at its depth.
float seen_before(Scattered here, float seen) { return here.in_front + (1.0 - here.in_front - here.behind) * seen; }

float density_before(ivec2 p) {
    Scattered here = scattered_at(p);
    return here.density * seen_before(here, texelFetch(veil, p, 0).r);
}
