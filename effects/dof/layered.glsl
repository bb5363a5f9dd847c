#include "known.glsl"
#ifdef FINDS_HIGHLIGHTS
#include "shine.glsl"
#endif

#ifdef KNOWS_LAYERS
float highlight_share_of(Known known, ivec2 p) {
#ifdef FINDS_HIGHLIGHTS
    if (known.is_there)
        return highlight_share(amount(known.light.color.rgb), texelFetch(surround, p / 8, 0).ba, abs(known.light.coc), vec2(p) + 0.5);
#endif
    return 0.0;
}

struct LayeredPatch {
    uvec4 texel;     // of `patches`
    vec4 highlight;  // of `hidden_highlight`
    bool is_there;
};

// What the layers have behind a surface of `coc_px` and, at most kOneLayerPx in front of `guessed_coc_px`, which may be infinite.
LayeredPatch layered_patch(ivec2 p, float coc_px, float guessed_coc_px) {
    Layers layers = layers_at(p, lens_at_infinity_px());
    // A small light may lie in front of what the chords lead to.
    Known known = known_behind(layers, coc_px + kClear);
    float share = highlight_share_of(known, p);
    if (share == 0.0 && guessed_coc_px < kHalfInfinity) {
        known = known_behind(layers, guessed_coc_px - kOneLayerPx);
        share = highlight_share_of(known, p);
    }
    vec4 highlight = vec4(share * known.light.color.rgb, share > 0.0 ? 1.0 : 0.0);
    known.light.color.rgb *= 1.0 - share;
    return LayeredPatch(pack_light(known.light), highlight, known.is_there);
}
#endif
