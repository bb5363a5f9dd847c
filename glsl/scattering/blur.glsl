// One of the two blurs of separable scattering, along rows or columns (Jimenez and others 2015). Before it is included:
// ALONG_ROWS 1 or 0, TAPS for the number of taps, KEEPS_OWN 1 where taps that fall off the object are the pixel's own light, 0
// where they are the mean of the others. Needs the textures facet, half_kernel (see half_kernel.glsl), along rows surface, and
// along columns rows: what the blur along rows made, packed.
#include <scattering/cut.glsl>
#include <scattering/lit.glsl>
#include <scattering/profile.glsl>

#if ALONG_ROWS
Lit lit_at(ivec2 p) {
    vec4 here = texelFetch(surface, p, 0);
    return Lit(here.rgb, here.a, texelFetch(facet, p, 0).r);
}
#else
Lit lit_at(ivec2 p) { return unpack(texelFetch(rows, p, 0)); }
#endif

// How much farther away than on the cut what is seen `pixels` away lies, mm.
float detour(ViewLines lines, Cut cut, float pixels, float depth_mm) {
    float angle = pixels * lines.slope.x;
    float across = angle * cut.depth_mm / max(1.0 - angle * cut.slope, 0.05);
    return length(depth_mm * (cut.line + angle * kAlong) - cut.depth_mm * cut.line) - abs(across) * cut.stretch;
}

// The light of a pixel, lit_at(p), after the blur.
vec3 blurred_light(ViewLines lines, ivec2 p, Lit here) {
    if (here.key == 0u) return here.light;
    ScatteringProfileRow profile = scattering_profile(here.key - 1u);
    Cut cut = cut_at(lines, p, here.depth_m);
    vec3 share = texelFetch(half_kernel, ivec2(0, profile.index), 0).rgb, sum = share * here.light;
    for (int i = 1; i <= TAPS / 2; ++i) {
        vec4 tap = texelFetch(half_kernel, ivec2(i, profile.index), 0);
        for (int side = -1; side <= 1; side += 2) {
            // The nearest pixel, whose light is that of its square. Mixed from two, edges at 25 taps would be off
            // by 0.020 instead of 0.024, for twice the fetches.
            float pixels = clamp(floor(pixels_to(lines, cut, float(side) * tap.a) + 0.5), -32768.0, 32768.0);
            ivec2 q_free = p + int(pixels) * kStep, q = clamp(q_free, ivec2(0), frame.size - 1);
            Lit there = lit_at(q);
            float farther = detour(lines, cut, pixels, param.world_unit * there.depth_m);
            vec3 weight = tap.rgb * exp(-max(farther, 0.0) / (3.0 * profile.d));
            if (q != q_free || there.key != here.key) continue;
            sum += weight * there.light;
            share += weight;
        }
    }
#if KEEPS_OWN
    return sum + (1.0 - share) * here.light;
#else
    return sum / share;
#endif
}
