// What stands for surface that the picture does not show. Needs the parameter normalize.

// What light found is divided by, of the share of the profile that it was found in; see the parameter normalize.
vec3 filling(vec3 share) {
#if NORMALIZE == NORMALIZE_ALL
    return max(share, 1e-20);
#elif NORMALIZE == NORMALIZE_MISSING
    return clamp(share, 1e-20, 1.0);
#else
    return vec3(1.0);
#endif
}

vec3 filled(vec3 sum, vec3 share) {
#if NORMALIZE == NORMALIZE_NONE
    return sum;
#else
    return sum / filling(share);
#endif
}
