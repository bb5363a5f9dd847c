#version 450 core
#include <pass>
#define HALF_SIZE
#include "blur.glsl"

void main() {
    ivec2 p = ivec2(gl_FragCoord.xy);
    Light own = unpack_light(texelFetch(plate_half, p, 0));
    vec2 center = 2.0 * vec2(p) + 1.0;
    vec4 around_coc = texelFetch(around, min(2 * p, frame.size - 1) / kTile, 0);
    float visible_coc = unpack_light(texelFetch(light, min(p, grid_of(1).last), 1)).coc, reach_px = front_reach_px(around_coc, own.coc, visible_coc);
    bool is_blurred = abs(own.coc) > kFullSizePx - 1.0, is_reached = reach_px > kFullSizePx;
    if (is_reached || is_blurred) prepare_outline_at(center);
    Gathered found = gather(Point(center, own, visible_coc, is_reached ? reach_px : kNotAsked, widest_radius_px(around_coc), kWide,
                                  is_blurred ? abs(own.coc) : kNotAsked), around_coc);
    Layer over = found.over;
    Back surface = found.surface;
    // Light and opacity must agree to the last bit for what is even to stay even, and opacity is stored as a half.
    float opacity = unpackHalf2x16(packHalf2x16(vec2(over.opacity))).x;
    out_front = pack_light(Light(over.color * (over.opacity > 0.0 ? opacity / over.opacity : 0.0), opacity));
    out_back = pack_light(Light(surface.color, surface.share));
    out_hides = over.hides;
}
