#version 450 core
#include <pass>
#define HALF_SIZE
#include "blur.glsl"
#define LOWER_FRONT front_quarter
#define LOWER_BACK back_quarter
#define LOWER_HIDES hides_quarter
#include "upsample.glsl"

void main() {
    ivec2 p = ivec2(gl_FragCoord.xy);
    Light own = half_plate_at(p);
    vec2 center = 2.0 * vec2(p) + 1.0;
    vec4 around_coc = texelFetch(around, min(2 * p, frame.size - 1) / kTile, 0);
    float visible_coc = tap_level(p, grid_of(1)).coc, reach_px = front_reach_px(around_coc, own.coc, visible_coc);
    float radius_px = abs(own.coc);
    bool is_blurred = radius_px > kFullSizePx - 1.0, is_reached = reach_px > kFullSizePx;
    if (is_reached || is_blurred) prepare_outline_at(center);
    Coarse coarse = upsampled(p, own.coc, visible_coc, kQuarterAlikePx, kHalfSizePx, textureSize(plate_quarter, 0) - 1);
    bool is_found = coarse.likeness >= kLeastLikeness;
    bool is_over_found = is_found && coarse.reached >= kLeastReached && reach_px > kHalfSizePx, is_back_found = is_found && radius_px > kHalfSizePx;
    Gathered found = gather(Point(center, own, visible_coc, is_reached && !is_over_found ? reach_px : kNotAsked, kWide,
                                  is_blurred && !is_back_found ? radius_px : kNotAsked), around_coc);
    Layer over = is_over_found ? coarse.over : found.over;
    Back surface = is_back_found ? coarse.surface : found.surface;
    out_front = pack_light(stored(over));
    out_back = pack_light(Light(surface.color, surface.share));
    out_hides = vec4(is_reached ? over.hides : kNotReached, own.coc, visible_coc);
}
