// What stands for surface that the picture does not show. Needs the parameter normalize.

// Light found over the share of the profile that it was found in; see the parameter normalize.
vec3 filled(vec3 sum, vec3 share) {
#if NORMALIZE == NORMALIZE_ALL
    return sum / max(share, 1e-20);
#elif NORMALIZE == NORMALIZE_MISSING
    return sum / clamp(share, 1e-20, 1.0);
#else
    return sum;
#endif
}
