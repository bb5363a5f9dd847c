// Ids that samples ask for, kept in buckets of four, first in, first out, each behind a lock (Liktor and Dachsbacher 2012, Decoupled Deferred
// Shading for Hardware Rasterization). No wait is longer than kAttempts, and the lock is opened in the branch that closed it, since lanes that
// run in step would wait for each other for ever; what gets no turn is counted as shaded again.
layout(std430, binding = 1) coherent buffer Table { uint keys[]; };        // kNoShading where empty
layout(std430, binding = 3) coherent buffer Buckets { uvec2 buckets[]; };  // x: 1 where locked; y: the place that is written next

const uint kPlaces = 4u;
const uint kAttempts = 256u;

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

// There is one table: `first_slot` is 0.
void request(uint id, uint first_slot) {
    uint bucket = first_slot + (mixed(id) & (slots - 1u));
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

