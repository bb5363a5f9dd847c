#version 450 core
#include <pass>
#define QUARTER_SIZE
#include "blur.glsl"

void main() {
    ivec2 p = ivec2(gl_FragCoord.xy);
    Light own = unpack_light(texelFetch(plate_quarter, p, 0));
    vec2 center = 4.0 * vec2(p) + 2.0;
    vec4 around_coc = texelFetch(around, min(4 * p, frame.size - 1) / kTile, 0);
    float visible_coc = tap_level(p, grid_of(2)).coc, reach_px = front_reach_px(around_coc, own.coc, visible_coc);
    // Between two texels lies what is up to kQuarterAlikePx wider than one of them.
    float radius_px = abs(own.coc);
    bool is_blurred = radius_px > kHalfSizePx - kQuarterAlikePx, is_reached = reach_px > kFullSizePx;
    if (is_reached || is_blurred) prepare_outline_at(center);
    Gathered found = gather(Point(center, own, visible_coc, is_reached ? reach_px : kNotAsked, kWide,
                                  is_blurred ? radius_px : kNotAsked), around_coc);
    out_front_quarter = pack_light(stored(found.over));
    out_back_quarter = pack_light(Light(found.surface.color, found.surface.share));
    out_hides_quarter = vec4(is_reached ? found.over.hides : kNotReached, own.coc, visible_coc);
}
