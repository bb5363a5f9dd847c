// What the texture guided_shares holds, in eight halves: the shares of an average, and its residual. Half of the bytes of floats:
// reading and writing history takes most of the time of a few samples.
#include <scattering/gathered.glsl>

uvec4 kept_shares(Gathered sums, vec2 residual) {
    // Normal halves: light over a share of 0 would be none.
    vec3 share = clamp(sums.share, 1e-4, 6e4), whole = clamp(sums.whole, 1e-4, 6e4);
    return uvec4(packHalf2x16(share.rg), packHalf2x16(vec2(share.b, whole.r)), packHalf2x16(whole.gb), packHalf2x16(residual));
}

vec2 residual_of(uvec4 kept) { return unpackHalf2x16(kept.w); }

// `light`: of samples that found these shares.
Gathered with_shares(vec3 light, uvec4 kept) {
    vec2 rg = unpackHalf2x16(kept.x), br = unpackHalf2x16(kept.y), gb = unpackHalf2x16(kept.z);
    return Gathered(light, vec3(rg, br.x), vec3(br.y, gb));
}
