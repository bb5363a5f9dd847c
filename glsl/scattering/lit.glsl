// Light, depth and object of a pixel, and how they are packed into one texel. Light keeps 12 bits of its mantissas: to 1.2e-4 of
// itself.

struct Lit {
    vec3 light;
    float depth_m;
    uint key;
};

uint shortened(float value) { return (floatBitsToUint(value) + 0x400u) >> 11; }

uvec4 pack(Lit lit) {
    uint r = shortened(lit.light.r), g = shortened(lit.light.g), b = shortened(lit.light.b);
    return uvec4(r | g << 21, g >> 11 | b << 10, floatBitsToUint(lit.depth_m), lit.key);
}

Lit unpack(uvec4 texel) {
    uvec3 bits = uvec3(texel.x << 11, texel.x >> 21 << 11 | texel.y << 22, texel.y >> 10 << 11);
    return Lit(uintBitsToFloat(bits), uintBitsToFloat(texel.z), texel.w);
}
