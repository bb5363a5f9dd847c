// A pixel that antialiasing has mixed from two surfaces: its own, by its depth, and one that its neighbour shows.
struct Mixture {
    float share;   // of the other surface; 0: there is none
    ivec2 across;  // from the pixel to the neighbour
};

uint pack_mixture(Mixture m) {
    return m.share <= 0.0 ? 0u : uint(m.share * 255.0 + 0.5) << 8u | uint(m.across.x + 1) << 4u | uint(m.across.y + 1);
}

Mixture unpack_mixture(uint bits) {
    return Mixture(float(bits >> 8u) / 255.0, bits == 0u ? ivec2(0) : ivec2(bits >> 4u & 15u, bits & 15u) - 1);
}
