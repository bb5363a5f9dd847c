// What leaves a scattering effect. Needs the texture irradiance, and the mask where there is one.

// The light that comes in where nothing scatters (key 0), bit for bit; elsewhere what scattered, as far as the mask says.
vec4 mixed_result(ivec2 pixel, uint key, vec3 scattered) {
    vec4 before = texelFetch(irradiance, pixel, 0);
    vec3 after = scattered;
#ifdef HAS_MASK
    after = mix(before.rgb, after, clamp(texelFetch(mask, pixel, 0).r, 0.0, 1.0));
#endif
    return key == 0u ? before : vec4(after, before.a);
}
