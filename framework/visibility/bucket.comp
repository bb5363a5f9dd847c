// Ids that samples ask for, kept in buckets of four, first in, first out, each behind a lock (Liktor and Dachsbacher 2012, Decoupled Deferred
// Shading for Hardware Rasterization). No wait is longer than kAttempts, and the lock is opened in the branch that closed it, since lanes that
// run in step would wait for each other for ever; what gets no turn is counted as shaded again.
layout(std430, binding = 1) coherent buffer Table { uint keys[]; };          // kNoShading where empty
layout(std430, binding = 3) coherent buffer Buckets { uvec2 buckets[]; };    // x: 1 where locked; y: the place that is written next
layout(std430, binding = 5) coherent buffer Addresses { uint addresses[]; };  // of the keys' light: shadings are numbered as they come

const uint kPlaces = 4u;
const uint kAttempts = 256u;

// The address of an id's light; kNoShading: it is not there. Reads are atomic: other invocations write at the same time. The key is read again
// after the address, which would be another's if the key went in between.
uint held(uint bucket, uint id) {
    uint found = kNoShading;
    for (uint i = 0u; i < kPlaces; ++i) {
        uint place = bucket * kPlaces + i;
        if (atomicOr(keys[place], 0u) != id) continue;
        memoryBarrierBuffer();
        uint address = atomicOr(addresses[place], 0u);
        memoryBarrierBuffer();
        if (atomicOr(keys[place], 0u) == id) found = address;
    }
    return found;
}

void store(uint bucket, uint id, uint address) {
    uint place = bucket * kPlaces + atomicAdd(buckets[bucket].y, 1u) % kPlaces;
    atomicExchange(keys[place], kNoShading);
    memoryBarrierBuffer();
    atomicExchange(addresses[place], address);
    memoryBarrierBuffer();
    atomicExchange(keys[place], id);
}

// There is one table: `first_slot` is 0.
uint request(uint id, uint first_slot) {
    uint bucket = first_slot + (mixed(id) & (slots - 1u));
    for (uint attempt = 0u; attempt < kAttempts && attempts_left > 0u; ++attempt, --attempts_left) {
        uint address = held(bucket, id);
        if (address != kNoShading) return address;
        if (atomicCompSwap(buckets[bucket].x, 0u, 1u) == 0u) {
            address = held(bucket, id);
            if (address == kNoShading) {
                address = shading_count + atomicAdd(misses, 1u);
                store(bucket, id, address);
            }
            memoryBarrierBuffer();
            atomicExchange(buckets[bucket].x, 0u);
            return address;
        }
    }
    atomicAdd(overflows, 1u);
    return kNoShading;
}

