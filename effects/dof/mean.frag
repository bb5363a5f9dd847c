#version 450 core
#include <pass>
#include <coverage.glsl>
#include <lens/own.glsl>

float amount(vec4 light) { return dot(light.rgb, vec3(1.0)); }

void main() {
    ivec2 last = ivec2(color_size.xy) - 1, corner = 8 * ivec2(gl_FragCoord.xy);
    vec2 sum = vec2(0.0);
    // From a place that varies: unrolled, as loops of constant bounds are, it took much longer to compile.
    ivec2 at = corner;
    do {
        at.x = corner.x;
        do {
            ivec2 p = min(at, last);
            float visible = amount(own_color(p));
            sum.x += visible;
#ifdef HAS_SECOND
            vec4 behind = texelFetch(second, p, 0);
            sum.y += has_coverage(behind.a) ? amount(behind) / behind.a : visible;
#endif
        } while (++at.x < corner.x + 8);
    } while (++at.y < corner.y + 8);
    out_mean = sum / 64.0;
}
