#include <scattering/filled.glsl>

// What samples of the profile found.
struct Gathered {
    vec3 light;
    vec3 share;   // of the profile, how much was found for each channel
    vec3 whole;   // the same of samples on a plane without end: 1 but for their noise
};

// The light scattered to the pixel.
vec3 filled(Gathered sums) { return filled(sums.light / sums.whole, sums.share / sums.whole); }

// Light of which `part` has scattered. Compilers write mix() in one of two ways, by what else the program holds; this has the same
// bits in every program.
vec3 in_part(vec3 light, vec3 scattered, float part) { return light * (1.0 - part) + scattered * part; }
