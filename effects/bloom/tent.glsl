// The wider level under a texel of the level below it: 3 x 3 bilinear taps weighted 1 2 1 each way. They cover 4 x 4 texels with
// weights that are products of one for each axis, so that four taps between these give the same sum.
vec4 tent() {
    vec2 at = 0.5 * gl_FragCoord.xy - 0.5, first = floor(at), part = at - first;
    // Along an axis the texels first - 1 to first + 2 weigh 1 - part, 2 - part, 1 + part and part, in quarters: two taps between
    // neighbours, each where its two weights put it.
    vec2 low_weight = 0.75 - 0.5 * part, high_weight = 0.25 + 0.5 * part;
    vec2 low = (first - 0.5 + (0.5 - 0.25 * part) / low_weight) * WIDER_SIZE.zw;
    vec2 high = (first + 1.5 + 0.25 * part / high_weight) * WIDER_SIZE.zw;
    vec4 upper = low_weight.x * textureLod(WIDER, low, 0.0) + high_weight.x * textureLod(WIDER, vec2(high.x, low.y), 0.0);
    vec4 lower = low_weight.x * textureLod(WIDER, vec2(low.x, high.y), 0.0) + high_weight.x * textureLod(WIDER, high, 0.0);
    return low_weight.y * upper + high_weight.y * lower;
}
