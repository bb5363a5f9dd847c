// The wider level under a texel of the level below it: 3 x 3 bilinear taps weighted 1 2 1 each way.
vec4 tent() {
    vec4 sum = vec4(0.0);
    for (int y = -1; y <= 1; ++y)
        for (int x = -1; x <= 1; ++x) {
            float weight = float((2 - abs(x)) * (2 - abs(y))) / 16.0;
            sum += weight * textureLod(WIDER, (0.5 * gl_FragCoord.xy + vec2(x, y)) * WIDER_SIZE.zw, 0.0);
        }
    return sum;
}
