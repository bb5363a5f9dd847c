#version 450 core
#include <pass>
#include "chords.glsl"
#include "hiding.glsl"
#include "layered.glsl"

void main() {
    ivec2 p = ivec2(gl_FragCoord.xy);
    Light own = tap_light(p);
    out_patches = kNoPatch;
#ifdef FINDS_HIGHLIGHTS
    out_hidden_highlight = vec4(0.0);
#endif
#ifdef SEES_NEIGHBOURS
    out_seen = 0.0;
#endif
    if (!may_hide(p, own.coc)) return;
    Patch hidden = patch_at(vec2(p) + 0.5, own);
#ifdef KNOWS_LAYERS
    LayeredPatch layered = layered_patch(p, own.coc, hidden.is_there ? hidden.mean.light.coc : kHalfInfinity);
    if (layered.is_there) {
#ifdef FINDS_HIGHLIGHTS
        out_hidden_highlight = layered.highlight;
#endif
        out_patches = layered.texel;
        return;
    }
#endif
    if (!hidden.is_there) return;
#ifdef SEES_NEIGHBOURS
    Chord mean = hidden.mean;
    View view = kNoView;
    if (mean.path_weight > 0.0)
        view = seen_by_neighbours(p, Guess(mean.light.color.rgb, mean.light.coc, mean.path, kTrustPx * hidden.trust), view);
    if (view.cost_px < kNoView.cost_px) {
        hidden.mean.light.color = view.color;
        out_seen = 1.0;
    }
#endif
    out_patches = pack_light(hidden.mean.light);
}
