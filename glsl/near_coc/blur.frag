#version 450 core
#include <pass>

// Five binomial taps of FROM in the direction STEP, into TO.
void main() {
    const float kWeights[3] = float[](0.375, 0.25, 0.0625);
    ivec2 p = ivec2(gl_FragCoord.xy), last = textureSize(FROM, 0) - 1;
    float sum = 0.0;
    for (int i = -2; i <= 2; ++i) sum += kWeights[abs(i)] * texelFetch(FROM, clamp(p + i * STEP, ivec2(0), last), 0).r;
    TO = sum;
}
