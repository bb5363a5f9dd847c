// The visible surface as facets: each pixel's square is flat, in the plane of its normal, and evenly lit. Needs the
// textures surface and facet.
#include <scattering/lines.glsl>

struct Facet {
    vec3 light;       // irradiance / pi
    float depth_m;    // at the pixel's middle; +inf where nothing scatters
    uint key;         // 0 where nothing scatters
    vec2 slope;       // depth's change over a pixel, in units of a pixel's width there
};

Facet read_facet(ivec2 pixel) {
    vec4 texel = texelFetch(surface, pixel, 0);
    uvec2 rest = texelFetch(facet, pixel, 0).rg;
    return Facet(texel.rgb, texel.a, rest.x, unpackHalf2x16(rest.y));
}

// Area of the facet over the area that its pixel has face-on at its depth: 1 / |n . L|.
float spread_of(vec2 slope, vec3 line) {
    return length(vec3(slope, 1.0 + slope.x * line.x - slope.y * line.y));
}

// Point of the facet at a place in px within its pixel's square, mm.
vec3 facet_position(ViewLines lines, Facet facet, ivec2 pixel, vec2 place) {
    float depth_m = facet.depth_m / (1.0 - lines.slope.x * dot(facet.slope, place - vec2(pixel) - 0.5));
    return view_position(lines, place, depth_m);
}
