#include <half.glsl>

// Colour and CoC in one RGBA32UI texel, so that a tap is one fetch: RGB as the bits of 32-bit floats, alpha and signed CoC
// radius (px) as halves. A half keeps a radius of 64 px to 1/32 px, and 0 and 1 of alpha exactly. Integers, because a
// float texture need not keep the bits of what is not a number.
struct Light {
    vec4 color;  // premultiplied
    float coc;
};

uvec4 pack_light(Light light) {
    return uvec4(floatBitsToUint(light.color.rgb), packHalf2x16(vec2(light.color.a, light.coc)));
}

Light unpack_light(uvec4 texel) {
    vec2 alpha_coc = halves_of(texel.w);
    return Light(vec4(uintBitsToFloat(texel.xyz), alpha_coc.x), alpha_coc.y);
}
