#version 450 core
#include <pass>
#include "taps.glsl"

void main() {
    ivec2 tile = ivec2(gl_FragCoord.xy), last = frame.size - 1;
    out_patched = 0.0;
    for (int y = 0; y < kTile; ++y)
        for (int x = 0; x < kTile; ++x)
            if (is_patch(unpack_light(texelFetch(patches, min(kTile * tile + ivec2(x, y), last), 0)))) out_patched = 1.0;
}
