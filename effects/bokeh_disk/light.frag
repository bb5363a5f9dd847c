#version 450 core
#include <pass>
#include <lens/packing.glsl>
#ifdef HAS_OUT_BEHIND
#include <lens/lens.glsl>
#include <lens/hidden.glsl>
#endif

void main() {
    ivec2 p = ivec2(gl_FragCoord.xy);
    Light own = Light(texelFetch(color, p, 0), texelFetch(coc, p, 0).r);
    out_light = pack_light(own);
#ifdef HAS_OUT_BEHIND
    Layers layers = layers_at(p, lens_at_infinity_px());
    int behind = layer_hidden_by(layers.coc[0], layers);  // coc may have been spread by coc_filter
    vec4 hidden = layers.color[behind];
    out_behind = behind > 0 ? pack_light(Light(vec4(hidden.rgb / hidden.a, own.color.a), layers.coc[behind])) : out_light;
#endif
}
