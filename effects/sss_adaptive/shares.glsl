// What the texture guided_shares holds, in eight halves: the shares of an average, and its residual. Half of the bytes of floats:
// reading and writing history takes most of the time of a few samples.
#include <scattering/gathered.glsl>

// Light over a share of 0 would be none.
const float kLeastShare = 1e-4, kMostShare = 6e4;

// Of the share found its difference from the whole is kept, which is next to nothing for most pixels: the ratio of two rounded
// shares would be noisy, which brightened long averages by 1e-4.
uvec4 kept_shares(Gathered sums, vec2 residual) {
    vec3 whole = clamp(sums.whole, kLeastShare, kMostShare), missing = clamp(sums.whole - sums.share, -kMostShare, kMostShare);
    return uvec4(packHalf2x16(missing.rg), packHalf2x16(vec2(missing.b, whole.r)), packHalf2x16(whole.gb), packHalf2x16(residual));
}

vec2 residual_of(uvec4 kept) { return unpackHalf2x16(kept.w); }

// `light`: of samples that found these shares.
Gathered with_shares(vec3 light, uvec4 kept) {
    vec2 rg = unpackHalf2x16(kept.x), br = unpackHalf2x16(kept.y), gb = unpackHalf2x16(kept.z);
    vec3 whole = vec3(br.y, gb);
    return Gathered(light, max(whole - vec3(rg, br.x), kLeastShare), whole);
}
