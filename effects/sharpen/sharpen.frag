#version 450 core
#include <pass>
#include "domain.glsl"

vec3 light_at(ivec2 p) { return texelFetch(color, clamp(p, ivec2(0), ivec2(color_size.xy) - 1), 0).rgb; }

#if METHOD == METHOD_UNSHARP
vec3 detail(ivec2 p) {
    int last = int(blurred_size.y) - 1, reach = reach_px(param.radius);
    vec3 sum = vec3(0.0);
    float weights = 0.0;
    for (int y = -reach; y <= reach; ++y) {
        float weight = gaussian(y, param.radius);
        sum += weight * texelFetch(blurred, ivec2(p.x, clamp(p.y + y, 0, last)), 0).rgb;
        weights += weight;
    }
    return param.amount * (compressed(light_at(p)) - sum / weights);
}
#else
// Each neighbour of the cross counts -w, so that the pixel gains 4 w / (1 - 4 w) of its difference from their mean. w is
// largest where there is room left towards black and white, none where the cross already spans the range; 0.2 is AMD's
// largest.
vec3 detail(ivec2 p) {
    vec3 middle = compressed(light_at(p));
    vec3 darkest = middle, brightest = middle, sum = vec3(0.0);
    const ivec2 kCross[4] = ivec2[](ivec2(0, -1), ivec2(-1, 0), ivec2(1, 0), ivec2(0, 1));
    for (int i = 0; i < 4; ++i) {
        vec3 tap = compressed(light_at(p + kCross[i]));
        darkest = min(darkest, tap);
        brightest = max(brightest, tap);
        sum += tap;
    }
    vec3 room = clamp(min(darkest, 1.0 - brightest) / max(brightest, 1e-6), 0.0, 1.0);
    vec3 w = sqrt(room) * param.amount / (1.0 + 4.0 * param.amount);
    return (middle - 0.25 * sum) * 4.0 * w / (1.0 - 4.0 * w);
}
#endif

vec3 limited(vec3 sharp, ivec2 p) {
    vec3 least = light_at(p), greatest = least;
    for (int y = -1; y <= 1; ++y)
        for (int x = -1; x <= 1; ++x) {
            vec3 tap = light_at(p + ivec2(x, y));
            least = mix(least, tap, lessThan(tap, least));
            greatest = mix(greatest, tap, greaterThan(tap, greatest));
        }
    return clamp(sharp, least, greatest);
}

void main() {
    ivec2 p = ivec2(gl_FragCoord.xy);
    vec4 texel = texelFetch(color, p, 0);
    // Nothing can be sharpened that is no number.
    if (param.amount == 0.0 || any(isnan(texel)) || any(isinf(texel))) {
        out_color = texel;
        return;
    }
    vec3 sharp = changed(texel.rgb, detail(p), param.amount);
#if LIMIT
    sharp = limited(sharp, p);
#endif
    out_color = vec4(sharp, texel.a);
}
