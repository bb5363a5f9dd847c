#version 450 core
#include <pass>
#include "faults.glsl"
#include "picture.glsl"

void main() {
    ivec2 p = ivec2(gl_FragCoord.xy), tile = p / param.tile_size, within = p - tile * param.tile_size;
    vec4 tile_data = texelFetch(longest, tile, 0);
    int faults = int(tile_data.w);
    vec2 v = clamp(tile_data.xy / texelFetch(range, ivec2(0), 0).y, -1e18, 1e18);
    vec3 fill = faults != 0 ? fault_color(faults) : wheel_color(v);
    // The outline has the wheel's own colour, and is seen where nothing moves, too.
    bool outline = any(equal(within, ivec2(0)));
    bool moves = faults != 0 || tile_data.z > 0.0;
    out_display = vec4(outline ? (moves ? fill : vec3(0.25)) : mix(dimmed_picture(p), fill, 0.5), 1.0);
}
