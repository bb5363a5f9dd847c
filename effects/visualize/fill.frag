#version 450 core
#include <pass>
#include "data.glsl"
#include "faults.glsl"
#include "picture.glsl"

vec3 color_of(vec4 data, vec2 ends) {
    float span = ends.y - ends.x;
#if SHOW == SHOW_VELOCITY
    return wheel_color(clamp(data.xy / ends.y, -1e18, 1e18));
#elif SHOW == SHOW_DEPTH
    if (data.r == 0.0) return vec3(0.0);  // against the contract, so it must not pass for near
#if DEPTH_SCALE == DEPTH_SCALE_LOG
    span = log(ends.y) - log(ends.x);
    return ramp_color(span != 0.0 ? 1.0 - (log(data.r) - log(ends.x)) / span : 1.0);
#else
    return ramp_color(span != 0.0 ? 1.0 - (data.r - ends.x) / span : 1.0);
#endif
#elif SHOW == SHOW_SIGNED
    return diverging_color(data.r / ends.y);
#elif SHOW == SHOW_SCALAR
    return ramp_color((data.r - ends.x) / span);
#elif SHOW == SHOW_NORMAL
    return data.rgb == vec3(0.0) ? vec3(0.0) : clamp(data.rgb * 0.5 + 0.5, 0.0, 1.0);
#else
    return encode_srgb(clamp(frame.rec709_from_color * data.rgb * exp2(param.exposure), 0.0, 1.0));
#endif
}

void main() {
    ivec2 p = ivec2(gl_FragCoord.xy);
#ifndef HAS_DATA
    vec3 result = dimmed_picture(p);
#elif SHOW == SHOW_OBJECT_ID
    vec3 result = id_color(texelFetch(object_id, p, 0).r);
#else
    vec4 data = data_at(p);
    int faults = faults_of(data);
    vec3 result = faults != 0 ? fault_color(faults) : color_of(data, texelFetch(range, ivec2(0), 0).xy);
#endif
    out_display = vec4(result, 1.0);
}
