// One direction of the blur that widens shadows: over the surface, by true distances, within one surface.

struct Spread {
    vec3 sum, weight, least, most;
};

// `from` of the pixel itself; `sigma_mm` of the blur. What is looked at is a pixel `off` away.
void add(inout Spread spread, vec3 seen, vec3 least, vec3 most, vec3 trust, float off_mm, vec3 sigma_mm) {
    vec3 deviations = off_mm / max(sigma_mm, 1e-6);
    vec3 weight = trust * exp(-0.5 * deviations * deviations) * vec3(lessThanEqual(deviations, vec3(kCut)));
    spread.sum += weight * seen;
    spread.weight += weight;
    bvec3 counts = greaterThan(trust * vec3(lessThanEqual(deviations, vec3(kCut))), vec3(0.02));
    spread.least = mix(spread.least, min(spread.least, least), counts);
    spread.most = mix(spread.most, max(spread.most, most), counts);
}

Spread nothing() { return Spread(vec3(0.0), vec3(0.0), vec3(kMostSeen), vec3(0.0)); }

int reach_px(vec3 sigma_mm, float per_mm) {
    float widest = max(sigma_mm.r, max(sigma_mm.g, sigma_mm.b));
    return min(int(ceil(kCut * widest * per_mm)), param.max_shadow_radius);
}

// Weights are brought to 1 for a pixel with all of its neighbours, which keeps them in their 10 bits.
void finish(Spread spread, vec3 sigma_mm, float per_mm, float depth_m, uint key, out uvec4 blurred, out uvec4 range) {
    const float root_two_pi = 2.5066283;
    vec3 full = max(root_two_pi * sigma_mm * per_mm, 1.0);
    bvec3 known = greaterThan(spread.weight, vec3(1e-3));
    vec3 seen = mix(vec3(1.0), spread.sum / max(spread.weight, 1e-20), known);
    blurred = uvec4(floatBitsToUint(seen), packed_weight(mix(vec3(0.0), spread.weight / full, known)));
    range = uvec4(packed_least(mix(vec3(1.0), spread.least, known)), packed_most(mix(vec3(1.0), spread.most, known)),
                  floatBitsToUint(depth_m), key);
}
