#version 450 core
#include <pass>
#include "motion.glsl"

vec2 finite(vec2 v) { return any(isnan(v)) || any(isinf(v)) ? vec2(0.0) : v; }

void main() {
    ivec2 p = ivec2(gl_FragCoord.xy);
    vec2 since = finite(texelFetch(velocity, p, 0).xy);
    vec2 next = since;
#if defined(HAS_VELOCITY_NEXT) && CURVE
    next = finite(texelFetch(velocity_next, p, 0).xy);
#endif
    vec2 span = shutter_span();
    float exposure = span.y - span.x;
#ifdef HAS_OBJECT_ID
    exposure *= objects(texelFetch(object_id, p, 0).r).scale;
#endif
    // Through -since, 0 and next at the times -1, 0 and 1.
    vec4 path = vec4(0.5 * (since + next) * exposure, 0.5 * (next - since) * exposure * exposure);
    float way = longest_way_px(path);
    if (way > param.max_blur) {
        path *= param.max_blur / way;
        way = param.max_blur;
    }
    out_motion = pack_motion(Motion(path, texelFetch(depth, p, 0).r, way));
}
