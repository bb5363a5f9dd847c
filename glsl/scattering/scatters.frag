#version 450 core
#include <pass>
#include <scattering/key.glsl>

const int kTile = 8;  // px

// Of light that is no number the pixels themselves take care.
bool scatters_at(ivec2 p) { return is_surface(texelFetch(depth, p, 0).r) && is_listed(p); }

void main() {
    ivec2 corner = kTile * ivec2(gl_FragCoord.xy), last = frame.size - 1;
    bool found = false;
    for (int i = 0; i < kTile * kTile && !found; ++i) found = scatters_at(min(corner + ivec2(i % kTile, i / kTile), last));
    out_scatters = found ? 1.0 : 0.0;
}
