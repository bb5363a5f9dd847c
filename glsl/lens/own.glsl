// Colour of the pixel's surface. Where layers share the pixel, that is not the picture's.
vec4 own_color(ivec2 p) {
    vec4 flat_color = texelFetch(color, p, 0);
#ifdef HAS_OWN
    vec4 alone = texelFetch(own, p, 0);
    if (alone.a > 0.5) return vec4(alone.rgb, flat_color.a);
#endif
    return flat_color;
}
