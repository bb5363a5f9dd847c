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
    LayeredPatch layered = layered_patch(p, own.coc, hidden.is_there ? hidden.light.coc : kHalfInfinity);
    if (layered.is_there) {
#ifdef FINDS_HIGHLIGHTS
        out_hidden_highlight = layered.highlight;
#endif
        out_patches = layered.texel;
        return;
    }
#endif
    if (!hidden.is_there) return;
    out_patches = pack_light(hidden.light);
}
