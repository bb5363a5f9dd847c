// Each pixel's facet is taken whole: pixels farther off by their middle, those nearby by a grid of kGrid x kGrid places, and
// of the pixel itself what lies within half a pixel by the profile's own integral.
#include <scattering/facet.glsl>
#include <scattering/profile.glsl>

const int kNear = 3;  // px to each side
const int kGrid = 5;

// Share, for each channel, that comes to the point `at` (mm) from an area of a facet that covers `area` px^2 around a place.
vec3 share_from(ScatteringProfileRow profile, vec3 at, ViewLines lines, Facet facet, ivec2 pixel, vec2 place, float area) {
    float side_mm = param.world_unit * facet.depth_m * lines.slope.x;
    float area_mm2 = area * side_mm * side_mm * spread_of(facet.slope, view_line(lines, place));
    float r = distance(at, facet_position(lines, facet, pixel, place));
    return r > profile.reach ? vec3(0.0) : area_mm2 * profile_density(profile, max(r, 1e-3 * side_mm));
}
