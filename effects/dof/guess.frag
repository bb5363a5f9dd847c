#version 450 core
#include <pass>
#define GUESSES
#include "chords.glsl"
#include "hiding.glsl"

// Behind the nearest of four pixels and, where that is another surface, the furthest. Neighbours' guesses are alike.
void main() {
    ivec2 last = frame.size - 1, corner = 2 * ivec2(gl_FragCoord.xy), p = min(corner, last);
    ivec2 places[2] = ivec2[2](p, p);
    Light owns[2];
    owns[0] = owns[1] = tap_light(p);
    for (int i = 1; i < 4; ++i) {
        ivec2 q = min(corner + ivec2(i & 1, i >> 1), last);
        Light tap = tap_light(q);
        if (tap.coc < owns[0].coc) {
            owns[0] = tap;
            places[0] = q;
        }
        if (tap.coc > owns[1].coc) {
            owns[1] = tap;
            places[1] = q;
        }
    }
    out_guessed = out_guessed_far = kNoPatch;
    bool are_two = owns[1].coc - owns[0].coc > kClear;
    out_guessed_of = vec2(owns[0].coc, are_two ? owns[1].coc : kHalfInfinity);
    bool hides_near = may_hide(places[0], owns[0].coc), hides_far = are_two && may_hide(places[1], owns[1].coc);
    int side = hides_near ? 0 : 1, end = hides_far ? 1 : 0;
    if (side > end) return;
    do {
        Light own = side == 0 ? owns[0] : owns[1];
        Patch patched = patch_at(vec2(side == 0 ? places[0] : places[1]) + 0.5, own);
        uvec4 texel = patched.is_there ? pack_light(patched.mean.light) : kNoPatch;
        if (side == 0) out_guessed = texel;
        else out_guessed_far = texel;
    } while (++side <= end);
}
