#version 450 core
#include <pass>
#include "tent.glsl"

// Going down adds a variance of 1.75 texels squared and coming up 2.75 for each level, in texels of the finer
// one, so that level n has 1.5 (4^n - 1) px squared.
float widest_level() { return 0.5 * log2(param.radius * param.radius / 1.5 + 1.0); }

void main() {
    vec4 own = texelFetch(OWN, ivec2(gl_FragCoord.xy), 0);
    float share = clamp(widest_level() - float(LEVEL), 0.0, 1.0);
    // The step from one level to the next is passed gradually, so that radius can be animated.
    OUT = mix(own, tent(), share * param.scatter);
}
