#version 450 core
// Ids that samples ask for, kept in buckets of four, first in, first out, each behind a lock (Liktor and Dachsbacher 2012, Decoupled Deferred
// Shading for Hardware Rasterization). No wait is longer than kAttempts, and the lock is opened in the branch that closed it, since lanes that
// run in step would wait for each other for ever; what gets no turn is counted as shaded again.
layout(local_size_x = 64) in;

layout(std430, binding = 0) readonly buffer Ids { uint ids[]; };
layout(std430, binding = 1) coherent buffer Table { uint keys[]; };    // kNoShading where empty
layout(std430, binding = 2) buffer Counts {
    uint requests;
    uint misses;
    uint overflows;
};
layout(std430, binding = 3) coherent buffer Buckets { uvec2 buckets[]; };  // x: 1 where locked; y: the place that is written next
layout(std140, binding = 0) uniform Settings {
    uint width_px;
    uint pixel_count;   // of the band
    uint sample_count;
    uint tile_px;
    uint slots;         // buckets, a power of two
};

const uint kNoShading = 0xffffffffu;
const uint kPlaces = 4u;
const uint kAttempts = 256u;

// Degski's 32-bit mixer: neighbouring ids go to places far apart.
uint mixed(uint x) {
    x = (x ^ (x >> 16)) * 0x45d9f3bu;
    x = (x ^ (x >> 16)) * 0x45d9f3bu;
    return x ^ (x >> 16);
}

// Reads are atomic: other invocations write at the same time.
bool holds(uint bucket, uint id) {
    bool found = false;
    for (uint place = 0u; place < kPlaces; ++place) found = found || atomicOr(keys[bucket * kPlaces + place], 0u) == id;
    return found;
}

void store(uint bucket, uint id) {
    uint place = atomicAdd(buckets[bucket].y, 1u) % kPlaces;
    atomicExchange(keys[bucket * kPlaces + place], id);
}

void request(uint id) {
    uint bucket = mixed(id) & (slots - 1u);
    for (uint attempt = 0u; attempt < kAttempts; ++attempt) {
        if (holds(bucket, id)) return;
        if (atomicCompSwap(buckets[bucket].x, 0u, 1u) == 0u) {
            bool is_new = !holds(bucket, id);
            if (is_new) store(bucket, id);
            memoryBarrierBuffer();
            atomicExchange(buckets[bucket].x, 0u);
            if (is_new) atomicAdd(misses, 1u);
            return;
        }
    }
    atomicAdd(overflows, 1u);
}

void main() {
    uint pixel = gl_GlobalInvocationID.x;
    if (pixel >= pixel_count) return;
    uint own = 0u;
    for (uint i = 0u; i < sample_count; ++i) {
        uint id = ids[pixel * sample_count + i];
        if (id == kNoShading) continue;
        ++own;
        request(id);
    }
    atomicAdd(requests, own);
}
