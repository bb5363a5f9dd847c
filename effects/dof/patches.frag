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
    float share;
    Known known = known_patch(p, own.coc, hidden.is_there ? hidden.mean.light.coc : kHalfInfinity, share);
    if (known.is_there) {
#ifdef FINDS_HIGHLIGHTS
        out_hidden_highlight = vec4(share * known.light.color.rgb, share > 0.0 ? 1.0 : 0.0);
#endif
        known.light.color.rgb *= 1.0 - share;
        out_patches = pack_light(known.light);
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
