// Who lands where, and a key whose minimum is the winner.
const int kReach = 31;  // px; longer throws stop there

ivec2 throw_of(ivec2 p) {
    vec2 motion = texelFetch(velocity, p, 0).rg * param.time;
    return clamp(ivec2(floor(motion + 0.5)), ivec2(-kReach), ivec2(kReach));
}

bool inside(ivec2 p) { return all(greaterThanEqual(p, ivec2(0))) && all(lessThan(p, frame.size)); }

// The upper 20 bits of the depth, which is positive and so orders as its bits do; below them the throw, 6 bits for each
// axis, by which two pixels of one depth that land together have different keys: the winner does not depend on the order
// of the atomics.
uint key_of(ivec2 p, ivec2 thrown) {
    uint far = floatBitsToUint(texelFetch(depth, p, 0).r) & 0xfffff000u;
    uvec2 from = uvec2(thrown + kReach);
    return far | (from.y << 6) | from.x;
}
