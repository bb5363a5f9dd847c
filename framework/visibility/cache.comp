#version 450 core
// Ids that samples ask for, each kept once in a table of open addresses. An attempt never waits for another invocation: what finds no place
// after kAttempts is counted as shaded again.
layout(local_size_x = 64) in;

layout(std430, binding = 0) readonly buffer Ids { uint ids[]; };
layout(std430, binding = 1) buffer Table { uint keys[]; };  // kNoShading where empty
layout(std430, binding = 2) buffer Counts {
    uint requests;
    uint misses;
    uint overflows;
};
layout(std140, binding = 0) uniform Settings {
    uint width_px;
    uint pixel_count;   // of the band
    uint sample_count;
    uint tile_px;       // 0: one table for the picture
    uint slots;         // of a table, a power of two
};

const uint kNoShading = 0xffffffffu;
const uint kAttempts = 128u;

// Degski's 32-bit mixer: neighbouring ids go to places far apart.
uint mixed(uint x) {
    x = (x ^ (x >> 16)) * 0x45d9f3bu;
    x = (x ^ (x >> 16)) * 0x45d9f3bu;
    return x ^ (x >> 16);
}

void request(uint id, uint first_slot) {
    uint slot = mixed(id);
    for (uint attempt = 0u; attempt < kAttempts; ++attempt, ++slot) {
        uint old = atomicCompSwap(keys[first_slot + (slot & (slots - 1u))], kNoShading, id);
        if (old == id) return;
        if (old == kNoShading) {
            atomicAdd(misses, 1u);
            return;
        }
    }
    atomicAdd(overflows, 1u);
}

void main() {
    uint pixel = gl_GlobalInvocationID.x;
    if (pixel >= pixel_count) return;
    uint first_slot = 0u;
    if (tile_px > 0u) {
        uint columns = (width_px + tile_px - 1u) / tile_px;
        first_slot = (pixel / width_px / tile_px * columns + pixel % width_px / tile_px) * slots;
    }
    uint own = 0u;
    for (uint i = 0u; i < sample_count; ++i) {
        uint id = ids[pixel * sample_count + i];
        if (id == kNoShading) continue;
        ++own;
        request(id, first_slot);
    }
    atomicAdd(requests, own);
}
