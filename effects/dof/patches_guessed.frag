#version 450 core
#include <pass>
#include "guessed.glsl"
#include "hiding.glsl"
#include "layered.glsl"

void main() {
    ivec2 p = ivec2(gl_FragCoord.xy);
    Light own = tap_light(p);
    out_patches = kNoPatch;
#ifdef FINDS_HIGHLIGHTS
    out_hidden_highlight = vec4(0.0);
#endif
    if (!may_hide(p, own.coc)) return;
    Hidden hidden = hidden_at(p, own.coc);
#ifdef KNOWS_LAYERS
    float share;
    Known known = known_patch(p, own.coc, hidden.is_there ? hidden.light.coc : kHalfInfinity, share);
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
    out_patches = pack_light(hidden.light);
}
