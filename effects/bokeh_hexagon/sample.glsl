// What a grid point has, in one RGBA32UI texel, so that a tap is one fetch: RGB as floats of 20 bits, in whose lowest four are
// 12 bits of alpha; CoC as a half; weight and opacity as 8 bits each. A value that is stored again keeps its bits.
struct Sample {
    vec4 color;     // premultiplied
    float coc;      // signed radius, px
    float weight;   // pixels in it over those of a mean grid point, at most 2
    float opacity;  // of what a first blur laid over it
};

uvec4 pack_sample(Sample s) {
    uint alpha = uint(clamp(s.color.a, 0.0, 1.0) * 4095.0 + 0.5);
    uvec3 rgb = (floatBitsToUint(s.color.rgb) + 8u) & 0xfffffff0u;
    uvec2 parts = uvec2(clamp(vec2(0.5 * s.weight, s.opacity), 0.0, 1.0) * 255.0 + 0.5);
    return uvec4(rgb | (uvec3(alpha, alpha >> 4, alpha >> 8) & 15u),
                 (packHalf2x16(vec2(s.coc, 0.0)) & 0xffffu) | (parts.x << 16) | (parts.y << 24));
}

Sample unpack_sample(uvec4 texel) {
    uint alpha = (texel.x & 15u) | ((texel.y & 15u) << 4) | ((texel.z & 15u) << 8);
    vec3 rgb = uintBitsToFloat(texel.xyz & 0xfffffff0u);
    return Sample(vec4(rgb, float(alpha) / 4095.0), unpackHalf2x16(texel.w).x, float((texel.w >> 16) & 255u) / 127.5,
                  float(texel.w >> 24) / 255.0);
}
