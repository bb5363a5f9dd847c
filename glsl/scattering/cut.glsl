// Where an even step along a row or column of the picture lies on the surface. Before it is included: ALONG_ROWS 1 or 0.
// Needs the texture facet.
#include <scattering/lines.glsl>

#if ALONG_ROWS
const ivec2 kStep = ivec2(1, 0);
const vec3 kAlong = vec3(1.0, 0.0, 0.0);  // in view space
#else
const ivec2 kStep = ivec2(0, 1);
const vec3 kAlong = vec3(0.0, -1.0, 0.0);
#endif

// The surface's plane through the pixel's middle, cut along the row or column. A step along it that goes t across the
// view goes slope * t in depth and stretch * t in all.
struct Cut {
    float depth_mm;
    float slope;
    float stretch;
    vec3 line;
};

Cut cut_at(ViewLines lines, ivec2 p, float depth_m) {
    vec2 slopes = unpackHalf2x16(texelFetch(facet, p, 0).g);
    float slope = ALONG_ROWS == 1 ? slopes.x : slopes.y;
    vec3 line = view_line(lines, vec2(p) + 0.5);
    return Cut(param.world_unit * depth_m, slope, length(slope * line + kAlong), line);
}

// Pixels to where the cut is x mm away.
float pixels_to(ViewLines lines, Cut cut, float x) {
    float across = x / cut.stretch;
    return across / (lines.slope.x * max(cut.depth_mm + across * cut.slope, 0.05 * cut.depth_mm));
}
