// Blurs the blurred rows along columns and puts the components together.
#include "kernel.glsl"

struct Blurred {
    vec4 color;   // times weight
    float weight;
    float whole;  // weight where all that the kernel covers is of this field
};

struct Rows {
    vec4 red_green, blue_alpha;
    vec2 weight;
};

Rows rows_at(int component, ivec2 texel) {
#if COMPONENTS == 3
    if (component == 2)
        return Rows(texelFetch(red_green_3, texel, 0), texelFetch(blue_alpha_3, texel, 0), texelFetch(weights_3, texel, 0).rg);
#endif
#if COMPONENTS >= 2
    if (component == 1)
        return Rows(texelFetch(red_green_2, texel, 0), texelFetch(blue_alpha_2, texel, 0), texelFetch(weights_12, texel, 0).ba);
#endif
    return Rows(texelFetch(red_green_1, texel, 0), texelFetch(blue_alpha_1, texel, 0), texelFetch(weights_12, texel, 0).rg);
}

void add_tap(inout Blurred sum, Walk walk, ivec2 p, float radius_px, int offset) {
    ivec2 texel = p + ivec2(0, offset);
    if (texel.y < 0 || texel.y >= frame.size.y) return;
    // The radius that the row was blurred by.
    float tap_radius = gather_radius(unpack_light(texelFetch(FIELD, texel, 0)), texelFetch(reach, texel / kTile, 0));
    float distance_px = abs(float(offset)), weight = cover(radius_px, distance_px) * seen(tap_radius, radius_px, distance_px);
    if (weight <= 0.0) return;
    for (int i = 0; i < COMPONENTS; ++i) {
        Rows rows = rows_at(i, texel);
        // A Re(z k) + B Im(z k) of a row's z is its scalar product with this.
        vec2 k = weight * (kComponents[i].z * vec2(walk.k[i].x, -walk.k[i].y) + kComponents[i].w * walk.k[i].yx);
        sum.color += vec4(dot(rows.red_green.xy, k), dot(rows.red_green.zw, k), dot(rows.blue_alpha.xy, k), dot(rows.blue_alpha.zw, k));
        sum.weight += dot(rows.weight, k);
    }
}

Blurred blur_columns(ivec2 p, float radius_px) {
    Blurred sum = Blurred(vec4(0.0), 0.0, 0.0);
    vec2 line[COMPONENTS];
    for (int i = 0; i < COMPONENTS; ++i) line[i] = vec2(0.0);
    Walk walk = start_walk(radius_px);
    for (int n = 0; n <= int(ceil(radius_px - 0.5)); ++n) {
        add_tap(sum, walk, p, radius_px, n);
        if (n > 0) add_tap(sum, walk, p, radius_px, -n);
        for (int i = 0; i < COMPONENTS; ++i) line[i] += (n > 0 ? 2.0 : 1.0) * cover(radius_px, float(n)) * walk.k[i];
        step_on(walk);
    }
    for (int i = 0; i < COMPONENTS; ++i) sum.whole += dot(kComponents[i].zw, multiply(line[i], line[i]));
    return sum;
}
