// Points on the unit disk, as far from each other and from the centre as goes, for the first 7, 8 and all 12 alike; the
// mean of all 12 is the centre, and of their squared radii 1/2, as a disk's. Found by random search.
const vec2 kPoisson[12] = vec2[](vec2(0.468, -0.385), vec2(0.63, 0.495), vec2(-0.47, -0.546), vec2(-0.512, 0.846),
                                 vec2(0.046, 0.608), vec2(-0.85, -0.087), vec2(0.971, -0.066), vec2(-0.459, 0.3),
                                 vec2(-0.409, -0.122), vec2(-0.059, -0.425), vec2(0.232, -0.74), vec2(0.408, 0.125));
