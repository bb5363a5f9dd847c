#version 450 core
#include <pass>

flat in vec4 light;
flat in float cover;
flat in vec3 middle_radius;

vec3 outline_to(float y) {
    float row = clamp(0.5 * (y + 1.0), 0.0, 1.0) * (outline_size.x - 1.0);
    return texelFetch(outline, ivec2(int(row + 0.5), 0), 0).rgb;
}

// The part of the splat's light that falls on this pixel: of each row of pixels the outline's area is exact, so that the
// parts add up to 1 at any radius. A negative radius turns the outline by 180 degrees.
float part_here() {
    float radius = middle_radius.z;
    if (radius == 0.0) return 1.0;
    vec2 offset = gl_FragCoord.xy - middle_radius.xy;
    float y = offset.y / radius, half_row = 0.5 / abs(radius);
    vec3 rows = outline_to(y + half_row) - outline_to(y - half_row);
    if (rows.z <= 0.0) return 0.0;
    vec2 ends = rows.xy / rows.z * radius;
    if (radius < 0.0) ends = ends.yx;
    float width = max(min(ends.y, offset.x + 0.5) - max(ends.x, offset.x - 0.5), 0.0);
    vec3 all = texelFetch(outline, ivec2(int(outline_size.x) - 1, 0), 0).rgb;
    return width * rows.z / (abs(radius) * (all.y - all.x));
}

void main() {
    float part = part_here();
    out_slices = part * light;
    out_coverage = part * cover;
}
