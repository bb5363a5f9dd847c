// Whether the loops of this invocation had all their turns: llvmpipe ends each after its first once 65,535 are over in all, without an error
// (lp_bld_limits.h). So does it with a loop of two turns, whose number the compiler must not know.
layout(std430, binding = 7) restrict buffer Unfinished { uint unfinished; };

void check_loops() {
    int wanted = 2 + int(unfinished >> 1), turns = 0;
    while (turns < wanted) ++turns;
    if (turns < wanted) unfinished = 1u;
}
