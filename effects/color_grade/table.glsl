// The .cube table between the curve that it is made for and light.

#if LUT_SPACE == LUT_SPACE_ACESCCT
// Academy S-2016-001, equations 8 and 9: a line below 0.0078125, a logarithm of base 2 above.
float to_table(float light) {
    return light <= 0.0078125 ? 10.5402377416545 * light + 0.0729055341958355 : (log2(light) + 9.72) / 17.52;
}
float from_table(float code) {
    return code <= 0.155251141552511 ? (code - 0.0729055341958355) / 10.5402377416545 : exp2(code * 17.52 - 9.72);
}
#elif LUT_SPACE == LUT_SPACE_SRGB
float to_table(float light) { return encode_srgb(vec3(clamp(light, 0.0, 1.0))).x; }
float from_table(float code) {  // IEC 61966-2-1
    return code <= 0.04045 ? code / 12.92 : pow((code + 0.055) / 1.055, 2.4);
}
#else
float to_table(float light) { return light; }
float from_table(float code) { return code; }
#endif

#ifdef HAS_LUT
bool has_table() { return param.lut_amount > 0.0; }
vec3 through_table(vec3 light) {
    vec3 code = lut(vec3(to_table(light.r), to_table(light.g), to_table(light.b)));
    return vec3(from_table(code.r), from_table(code.g), from_table(code.b));
}
#else
bool has_table() { return false; }
vec3 through_table(vec3 light) { return light; }
#endif
