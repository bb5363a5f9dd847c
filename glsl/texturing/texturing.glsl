// The albedo's two factors, whose product it is: onto light before it scatters, and after.

vec3 albedo_before(vec3 albedo) {
#if TEXTURING == TEXTURING_POST
    return vec3(1.0);
#elif TEXTURING == TEXTURING_PRE_AND_POST
    return sqrt(max(albedo, 0.0));
#else
    return albedo;
#endif
}

vec3 albedo_after(vec3 albedo) {
#if TEXTURING == TEXTURING_POST
    return albedo;
#elif TEXTURING == TEXTURING_PRE_AND_POST
    return sqrt(max(albedo, 0.0));
#else
    return vec3(1.0);
#endif
}

// What scattering takes, of light without albedo. Its bits are the same in every shader that has it (precise), so that a
// pixel whose light did not change can be told.
vec3 light_before(vec3 light, vec3 albedo) {
    precise vec3 before = albedo_before(albedo) * light;
    return before;
}
