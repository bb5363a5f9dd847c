#version 450 core
#include <pass>
#include "loads.glsl"
#include "plate.glsl"
#include "sent_from.glsl"

#ifdef SILHOUETTES
// The offset to a pixel whose visible surface has this CoC radius: that of the surface which is hidden at p.
ivec2 likest(ivec2 p, float coc) {
    const ivec2 kWays[8] = ivec2[](ivec2(1, 0), ivec2(-1, 0), ivec2(0, 1), ivec2(0, -1), ivec2(1, 1), ivec2(-1, -1), ivec2(1, -1), ivec2(-1, 1));
    const float kUnlikePerPx = 0.02;
    ivec2 found = ivec2(0);
    float least = 1e9;
    for (int i = 1; i <= 64; i += max(i / 3, 1))
        for (int k = 0; k < 8; ++k) {
            ivec2 to = kWays[k] * (k < 4 ? i : (3 * i + 2) / 4), at = p + to;  // slanted ways are longer
            if (clamp(at, ivec2(0), frame.size - 1) != at) continue;
            float unlike = abs(texelFetch(lit_coc, at, 0).r - coc) + kUnlikePerPx * float(i);
            found = unlike < least ? to : found;
            least = min(least, unlike);
        }
    return found;
}
#endif

void main() {
    ivec2 p = ivec2(gl_FragCoord.xy);
    vec2 behind_px = vec2(0.0);
#ifdef SILHOUETTES
    float coc = plate_at(p).coc;
    if (tap_light(p).coc < coc - kClear) behind_px = vec2(likest(p, coc));
#endif
    out_foreground_place = vec4(sent_offset_px(texelFetch(sent_from, p, 0).r), behind_px);
}
