#version 450 core
#include <pass>

// Nodes stand on the display window's pixels; beyond the outermost ones their last values hold.
vec4 between_nodes(sampler2D nodes, vec2 at) {
    ivec2 last = textureSize(nodes, 0) - 1;
    vec2 cell = clamp((at - 0.5) / native.spacing, vec2(0.0), vec2(last));
    ivec2 low = ivec2(cell), high = min(low + 1, last);
    vec2 part = cell - vec2(low);
    return mix(mix(texelFetch(nodes, low, 0), texelFetch(nodes, ivec2(high.x, low.y), 0), part.x),
               mix(texelFetch(nodes, ivec2(low.x, high.y), 0), texelFetch(nodes, high, 0), part.x), part.y);
}

vec4 texel(ivec2 at) {
    bool inside = all(greaterThanEqual(at, ivec2(0))) && all(lessThan(at, ivec2(color_size.xy)));
    return inside ? texelFetch(color, at, 0) : vec4(0.0);
}

// Catmull-Rom through the texels, so that a shift by whole px changes nothing; a light smaller than a texel may
// not turn negative.
vec4 weights(float t) {
    return 0.5 * vec4(((2.0 - t) * t - 1.0) * t, (3.0 * t - 5.0) * t * t + 2.0, ((4.0 - 3.0 * t) * t + 1.0) * t,
                      (t - 1.0) * t * t);
}
vec4 light_at(vec2 at) {
    vec2 from_centre = at - vec2(frame.origin) - 0.5;
    ivec2 low = ivec2(floor(from_centre));
    vec2 part = from_centre - vec2(low);
    vec4 columns = weights(part.x), rows = weights(part.y), sum = vec4(0.0);
    for (int y = 0; y < 4; ++y)
        for (int x = 0; x < 4; ++x)
            sum += columns[x] * rows[y] * texel(low + ivec2(x - 1, y - 1));
    return max(sum, vec4(0.0));
}

void main() {
    vec2 at = gl_FragCoord.xy + vec2(frame.origin);
    vec4 to_red_blue = between_nodes(red_blue, at);
    vec4 to_green = between_nodes(green_gain, at);
    vec4 green = light_at(at + to_green.xy);
    vec3 light = vec3(light_at(at + to_red_blue.xy).r, green.g, light_at(at + to_red_blue.zw).b);
#if DIRECTION == DIRECTION_REMOVE
    // The fall-off lies over the input, where the picture of the lens is.
    float gain = between_nodes(green_gain, at + to_green.xy).z;
#else
    float gain = to_green.z;
#endif
    out_color = vec4(light * gain, green.a);
}
