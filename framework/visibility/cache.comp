// Ids that samples ask for, each kept once in a table of open addresses, whose slot is the place of its light. An attempt never waits for
// another invocation: what finds no place after kAttempts is shaded again.
layout(std430, binding = 1) buffer Table { uint keys[]; };  // kNoShading where empty

const uint kAttempts = 128u;

uint request(uint id, uint first_slot) {
    uint slot = mixed(id);
    for (uint attempt = 0u; attempt < kAttempts && attempts_left > 0u; ++attempt, ++slot, --attempts_left) {
        uint place = first_slot + (slot & (slots - 1u)), old = atomicCompSwap(keys[place], kNoShading, id);
        if (old == kNoShading) atomicAdd(misses, 1u);
        if (old == id || old == kNoShading) return place;
    }
    atomicAdd(overflows, 1u);
    return kNoShading;
}

