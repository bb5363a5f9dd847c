// What a blur at a lower resolution has of a pixel or texel between four of its texels.
struct Coarse {
    Layer over;
    Back surface;
    float likeness;  // share of the texels, by bilinear weight, that show the surface or stand for it
    float reached;   // of these, the share whose `over` was gathered
};

// Where a thin thing is lost at the lower resolution, its texels are gathered one by one.
const float kLeastLikeness = 0.6;
// Smaller shares are of pixels beside tiles whose reach is too short; these gather `over` at the finer resolution.
const float kLeastReached = 0.25;

// p: at twice the resolution of LOWER_FRONT, LOWER_BACK and LOWER_HIDES, whose last texel is `last`; alike_px: a difference of
// CoC radii of two surfaces. Texels that show the visible surface count too: where its clean plate ends, one texel has the plate below
// it and the next has not, but both make the same picture. What a surface adds to that is weighted by how much of it is seen.
Coarse upsampled(ivec2 p, float coc, float visible_coc, float alike_px, float least_px, ivec2 last) {
    float seen = 0.0;
    vec2 at = 0.5 * (vec2(p) + 0.5) - 0.5;
    ivec2 corner = ivec2(floor(at));
    vec2 part = at - vec2(corner);
    Coarse coarse = Coarse(kNothing, Back(vec4(0.0), 0.0), 0.0, 0.0);
    for (int i = 0; i < 4; ++i) {
        ivec2 to = ivec2(i & 1, i >> 1), texel = clamp(corner + to, ivec2(0), last);
        Light b = unpack_light(texelFetch(LOWER_BACK, texel, 0)), f = unpack_light(texelFetch(LOWER_FRONT, texel, 0));
        if (b.coc < 0.0) continue;  // of a tile that is not blurred so far
        vec2 linear = mix(1.0 - part, part, vec2(to));
        vec4 hides = texelFetch(LOWER_HIDES, texel, 0);
        float texel_coc = hides.b, unlike_px = abs(texel_coc - coc), visible_unlike_px = abs(hides.a - visible_coc);
        if (min(abs(texel_coc), abs(coc)) > least_px) unlike_px = min(unlike_px, visible_unlike_px);
        float weight = linear.x * linear.y * max(1.0 - unlike_px / alike_px, 0.0), uncovered = weight * max(1.0 - f.coc, 1e-3);
        coarse.likeness += weight;
        seen += uncovered;
        coarse.surface.color += uncovered * b.color;
        coarse.surface.share += uncovered * b.coc;
        if (hides.r < 0.0) continue;
        coarse.reached += weight;
        coarse.over.color += weight * f.color;
        coarse.over.opacity += weight * f.coc;
        coarse.over.hides += weight * hides.rg;
    }
    float scale = 1.0 / max(coarse.reached, 1e-6), surface_scale = 1.0 / max(seen, 1e-9);
    coarse.over = Layer(coarse.over.color * scale, coarse.over.opacity * scale, coarse.over.hides * scale);
    coarse.surface = Back(coarse.surface.color * surface_scale, coarse.surface.share * surface_scale);
    return coarse;
}
