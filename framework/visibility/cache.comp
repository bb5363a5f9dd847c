// Ids that samples ask for, each kept once in a table of open addresses. An attempt never waits for another invocation: what finds no place
// after kAttempts is counted as shaded again.
layout(std430, binding = 1) buffer Table { uint keys[]; };  // kNoShading where empty

const uint kAttempts = 128u;

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

