#version 450 core
#include <pass>
#include <lens/packing.glsl>
#include <lens/own.glsl>
#include "highlights.glsl"
#include "tile.glsl"

layout(local_size_x = 16, local_size_y = 16) in;  // a tile each

// A pixel at the rim of a light has less of its light than those inside, and has it on their side: where the middle of that part
// is, from the pixel's centre, px.
vec2 middle_of_light(ivec2 p, float coc_px) {
    float own = dot(own_color(p).rgb, vec3(1.0)), brightest = own;
    vec2 side = vec2(0.0);
    // From a place that varies, so that a compiler does not unroll it.
    ivec2 beside = p - 1;
    do {
        beside.x = p.x - 1;
        do {
            ivec2 q = clamp(beside, ivec2(0), frame.size - 1);
            if (abs(texelFetch(lit_coc, q, 0).r - coc_px) > 1.0) continue;
            float amount = dot(own_color(q).rgb, vec3(1.0));
            brightest = max(brightest, amount);
            side += amount * vec2(beside - p);
        } while (++beside.x <= p.x + 1);
    } while (++beside.y <= p.y + 1);
    return brightest > 0.0 && dot(side, side) > 0.0 ? 0.5 * (1.0 - own / brightest) * normalize(side) : vec2(0.0);
}

void note_highlight(ivec2 p) {
    vec3 rgb = own_color(p).rgb - unpack_light(texelFetch(light, p, 0)).color.rgb;
    imageStore(highlight, p, pack_highlight(Highlight(rgb, middle_of_light(p, texelFetch(lit_coc, p, 0).r))));
}

void main() {
    ivec2 tile = ivec2(gl_GlobalInvocationID.xy), corner = kTile * tile, end = min(corner + kTile, frame.size);
    if (any(greaterThanEqual(corner, frame.size))) return;
    int number = tile.y * tiles_in_a_row() + tile.x;
    if (tile_count[number] == 0u) return;
    uint next = tile_first[number];
    for (int y = corner.y; y < end.y; ++y)
        for (int x = corner.x; x < end.x; ++x) {
            ivec2 p = ivec2(x, y);
            if (texelFetch(is_highlight, p, 0).r > 0.5) {
                note_highlight(p);
                highlight_list[next++] = place_of(p);
            }
#ifdef HAS_HIDDEN_HIGHLIGHT
            if (texelFetch(hidden_highlight, p, 0).a > 0.5) highlight_list[next++] = place_of(p) | kHidden;
#endif
        }
}
