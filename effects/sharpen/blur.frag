#version 450 core
#include <pass>
#include "domain.glsl"

void main() {
    ivec2 p = ivec2(gl_FragCoord.xy);
    int last = int(color_size.x) - 1, reach = reach_px(param.radius);
    vec3 sum = vec3(0.0);
    float weights = 0.0;
    for (int x = -reach; x <= reach; ++x) {
        float weight = gaussian(x, param.radius);
        sum += weight * compressed(texelFetch(color, ivec2(clamp(p.x + x, 0, last), p.y), 0).rgb);
        weights += weight;
    }
    out_blurred = vec4(sum / weights, 0.0);
}
