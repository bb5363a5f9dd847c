// What leaves a scattering effect. Needs the textures irradiance and facet, and the mask where there is one.

// The light that comes in where nothing scatters, bit for bit; elsewhere what scattered, as far as the mask says.
vec4 scattered_result(ivec2 pixel, vec3 scattered) {
    vec4 before = texelFetch(irradiance, pixel, 0);
    vec3 after = scattered;
#ifdef HAS_MASK
    after = mix(before.rgb, after, clamp(texelFetch(mask, pixel, 0).r, 0.0, 1.0));
#endif
    return texelFetch(facet, pixel, 0).r == 0u ? before : vec4(after, before.a);
}
