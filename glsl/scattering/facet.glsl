// The visible surface as facets: each pixel's square is flat and evenly lit. Needs the textures surface and facet.
#include <scattering/lines.glsl>

struct Facet {
    vec3 light;      // irradiance / pi
    float depth_m;   // at the pixel's middle; 3e38 where nothing scatters
    uint key;        // 0 where nothing scatters
    vec3 position;   // of the pixel's middle in view space, mm
    vec3 normal;     // view space, unit length, towards the camera
    float side_mm;   // of the pixel's square, face-on at its depth
    float spread;    // surface over that square: 1 face-on, more at a slant
};

// What a facet's own plane has at another pixel; without area where that looks past the plane.
Facet facet_on_plane(ViewLines lines, Facet here, ivec2 pixel) {
    vec3 line = view_line(lines, vec2(pixel) + 0.5);
    float facing = dot(here.normal, line);
    bool seen = facing < -1e-3;
    float depth_mm = dot(here.normal, here.position) / (seen ? facing : -1.0), side_mm = depth_mm * lines.slope.x;
    return Facet(here.light, depth_mm / param.world_unit, here.key, depth_mm * line, here.normal, side_mm,
                 seen ? -1.0 / facing : 0.0);
}

// With the slopes s of depth a facet's plane has, up to its length, the normal (s_x, -s_y, 1 + s_x X - s_y Y), where
// (X, Y, -1) is the line through the pixel; that length is the facet's area over that of its pixel face-on.
Facet read_facet(ViewLines lines, ivec2 pixel) {
    vec4 texel = texelFetch(surface, pixel, 0);
    uvec2 rest = texelFetch(facet, pixel, 0).rg;
    vec2 slope = unpackHalf2x16(rest.y);
    vec3 line = view_line(lines, vec2(pixel) + 0.5);
    vec3 steep = vec3(slope.x, -slope.y, 1.0 + slope.x * line.x - slope.y * line.y);
    float spread = length(steep), side_mm = param.world_unit * texel.a * lines.slope.x;
    return Facet(texel.rgb, texel.a, rest.x, param.world_unit * texel.a * line, steep / spread, side_mm, spread);
}
