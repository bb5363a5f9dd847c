#if COMBINE == COMBINE_MIN
vec4 combine(vec4 a, vec4 b) { return min(a, b); }
#else
vec4 combine(vec4 a, vec4 b) { return max(a, b); }
#endif
