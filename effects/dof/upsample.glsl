// What a blur at a lower resolution has of a pixel or texel between four of its texels.
struct Coarse {
    Layer over;
    Back surface;
    float likeness;  // share of the texels, by bilinear weight, that show the surface
};

// Where a thin thing is lost at the lower resolution, its texels are gathered one by one.
const float kLeastLikeness = 0.6;

// p: at twice the resolution of LOWER_FRONT, LOWER_BACK, LOWER_HIDES and LOWER_PLATE; alike_px: a difference of CoC radii of two surfaces.
Coarse upsampled(ivec2 p, float coc, float alike_px, ivec2 last) {
    vec2 at = 0.5 * (vec2(p) + 0.5) - 0.5;
    ivec2 corner = ivec2(floor(at));
    vec2 part = at - vec2(corner);
    Coarse coarse = Coarse(kNothing, Back(vec4(0.0), 0.0), 0.0);
    for (int i = 0; i < 4; ++i) {
        ivec2 to = ivec2(i & 1, i >> 1), texel = clamp(corner + to, ivec2(0), last);
        Light b = unpack_light(imageLoad(LOWER_BACK, texel)), f = unpack_light(imageLoad(LOWER_FRONT, texel));
        if (b.coc < 0.0) continue;  // of a tile that is not blurred so far
        vec2 linear = mix(1.0 - part, part, vec2(to));
        float texel_coc = unpack_light(imageLoad(LOWER_PLATE, texel)).coc;
        float weight = linear.x * linear.y * max(1.0 - abs(texel_coc - coc) / alike_px, 0.0);
        coarse.likeness += weight;
        coarse.surface.color += weight * b.color;
        coarse.surface.share += weight * b.coc;
        coarse.over.color += weight * f.color;
        coarse.over.opacity += weight * f.coc;
        coarse.over.hides += weight * imageLoad(LOWER_HIDES, texel).rg;
    }
    float scale = 1.0 / max(coarse.likeness, 1e-6);
    coarse.over = Layer(coarse.over.color * scale, coarse.over.opacity * scale, coarse.over.hides * scale);
    coarse.surface = Back(coarse.surface.color * scale, coarse.surface.share * scale);
    return coarse;
}
