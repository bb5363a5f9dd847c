#version 450 core
#include <pass>
#include "path.glsl"

#ifdef HAS_OUT_SHARE
const float kWholePixel = 0.999, kAlike_px = 0.5;

// Of two depths at a pixel, through the whole exposure.
bool moves_alike(float per_m, float other_per_m) {
    vec2 span = shutter_span();
    if (!camera_moves() || span.y <= span.x) return true;
    Motion motion = camera_motion();
    Sight sight = sight_of(gl_FragCoord.xy);
    Moment opens = moment_at(motion, sight, span, span.x), closes = moment_at(motion, sight, span, span.y);
    vec2 apart = max(abs(offset_at(opens, sight, per_m) - offset_at(opens, sight, other_per_m)),
                     abs(offset_at(closes, sight, per_m) - offset_at(closes, sight, other_per_m)));
    return max(apart.x, apart.y) <= kAlike_px;
}
#endif

// Where several surfaces share the pixel, the nearest one. Surfaces that move alike are one.
void main() {
    ivec2 p = ivec2(gl_FragCoord.xy);
    out_surface = inverse_depth(texelFetch(depth, p, 0).r);
#ifdef HAS_OUT_SHARE
    float alpha = texelFetch(first, p, 0).a;
    float front = inverse_depth(texelFetch(first_depth, p, 0).r), behind = inverse_depth(texelFetch(second_depth, p, 0).r);
    bool is_shared = alpha > 0.0 && alpha < kWholePixel && texelFetch(second, p, 0).a > 0.0 && !moves_alike(front, behind);
    out_share = is_shared ? alpha : 1.0;
    if (is_shared) out_surface = front;
#endif
#ifdef HAS_OBJECT_ID
    if (!objects(texelFetch(object_id, p, 0).r).blurs) out_surface = -1.0;
#endif
}
