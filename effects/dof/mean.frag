#version 450 core
#include <pass>
#include <lens/own.glsl>

float amount(vec4 light) { return dot(light.rgb, vec3(1.0)); }

void main() {
    ivec2 last = ivec2(color_size.xy) - 1, corner = 8 * ivec2(gl_FragCoord.xy);
    vec2 sum = vec2(0.0);
    for (int y = 0; y < 8; ++y)
        for (int x = 0; x < 8; ++x) {
            ivec2 p = min(corner + ivec2(x, y), last);
            float visible = amount(own_color(p));
            sum.x += visible;
#ifdef HAS_SECOND
            vec4 behind = texelFetch(second, p, 0);
            sum.y += behind.a > 0.0 ? amount(behind) / behind.a : visible;
#endif
        }
    out_mean = sum / 64.0;
}
