// The .cube table between the curve that it is made for and light.

#if LUT_SPACE == LUT_SPACE_ACESCCT
// Academy S-2016-001, equations 8 and 9: a line below 0.0078125, a logarithm of base 2 above.
vec3 to_table(vec3 light) {
    vec3 high = (log2(max(light, 0.0078125)) + 9.72) / 17.52;
    return mix(high, 10.5402377416545 * light + 0.0729055341958355, lessThanEqual(light, vec3(0.0078125)));
}
vec3 from_table(vec3 code) {
    vec3 low = (code - 0.0729055341958355) / 10.5402377416545;
    return mix(exp2(code * 17.52 - 9.72), low, lessThanEqual(code, vec3(0.155251141552511)));
}
#elif LUT_SPACE == LUT_SPACE_SRGB
vec3 to_table(vec3 light) { return encode_srgb(clamp(light, 0.0, 1.0)); }
vec3 from_table(vec3 code) { return decode_srgb(code); }
#else
vec3 to_table(vec3 light) { return light; }
vec3 from_table(vec3 code) { return code; }
#endif

#ifdef HAS_LUT
bool has_table() { return param.lut_amount > 0.0; }
vec3 through_table(vec3 light) { return from_table(lut(to_table(light))); }
#else
bool has_table() { return false; }
vec3 through_table(vec3 light) { return light; }
#endif
