#version 450 core
#include <pass>
#include "taps.glsl"
#include "known.glsl"
#include "near_tile.glsl"

// Neighbouring pixels may have taken different chords: the mean of 3 x 3 patches of one surface hides where. Its middle counts most, so
// that edges stay sharp.
const float kBeside = 0.3;

void main() {
    ivec2 p = ivec2(gl_FragCoord.xy), last = frame.size - 1;
    uvec4 patched = texelFetch(patches, p, 0);
    out_plate = pack_plate(patched);
    Light own = unpack_light(patched);
    if (!is_patch(own)) return;
#ifdef KNOWS_LAYERS
    Known known = known_behind(layers_at(p, lens_at_infinity_px()), own.coc - kOneLayerPx);
    if (known.is_there && abs(known.light.coc - own.coc) < 0.1) return;
#endif
#ifdef HAS_SEEN
    if (texelFetch(seen, p, 0).r > 0.5) return;
#endif
    vec4 color = vec4(0.0);
    float coc = 0.0, sum = 0.0;
    for (int y = -1; y <= 1; ++y)
        for (int x = -1; x <= 1; ++x) {
            ivec2 q = clamp(p + ivec2(x, y), ivec2(0), last);
            Light tap = unpack_light(texelFetch(patches, q, 0));
            if (!is_near(q / kTile) || !is_patch(tap) || abs(tap.coc - own.coc) > 1.0) continue;
            float weight = (x == 0 && y == 0 ? 1.0 : kBeside) / float(1 << (abs(x) + abs(y)));
            color += weight * tap.color;
            coc += weight * tap.coc;
            sum += weight;
        }
    out_plate = pack_plate(pack_light(Light(color / sum, coc / sum)));
}
