#version 450 core
#include <pass>
#include <shutter/random_phase.glsl>
#include <behind.glsl>
#include "path.glsl"

// Within which a guess and the better one that it led to are one place, px.
const float kAgree_px = 0.5;
const int kTile = 16;

ivec2 texel_at(vec2 px) { return clamp(ivec2(floor(px)), ivec2(0), frame.size - 1); }

#if OCCLUSION
// A place that may be what a pixel shows at a moment: sought at the depth of a surface, it has a surface of its own, whose depth
// leads to a better place, which is the same if the camera sees this surface there.
struct Guess {
    vec2 better;  // px from the pixel
    float found;  // the surface that led there
    bool agrees;
};

Guess guess(Moment moment, Sight sight, float sought, vec2 here) {
    vec2 at = offset_at(moment, sight, sought);
    float found = texelFetch(surface, texel_at(here + at), 0).r;
    vec2 better = offset_at(moment, sight, max(found, 0.0));
    return Guess(better, found, found >= 0.0 && distance(better, at) < kAgree_px);
}

#if defined(HAS_SECOND) && defined(HAS_SECOND_DEPTH)
// Of the capture's second layer, sought first at a surface beside it; alpha 0 where the layer shows nothing.
vec4 known_behind(Moment moment, Sight sight, float sought, vec2 here) {
    ivec2 texel = texel_at(here + offset_at(moment, sight, max(sought, 0.0)));
    float found = inverse_depth(texelFetch(second_depth, texel, 0).r);
    texel = texel_at(here + offset_at(moment, sight, max(found, 0.0)));
    return covering(texelFetch(second, texel, 0));
}
#endif

// Of what lies at the pixel's own depth and what may come over it, the nearest that agrees. Where neither does, what was hidden
// comes out (`known`, where the capture has it); what is known of it from one layer is the farther surface beside it.
ivec2 visible(Moment moment, Sight sight, float own, float nearest, vec2 here, out vec4 known) {
    known = vec4(0.0);
    Guess back = guess(moment, sight, own, here), front = guess(moment, sight, nearest, here);
    if (front.agrees && (!back.agrees || front.found > back.found)) return texel_at(here + front.better);
    ivec2 texel = texel_at(here + back.better);
    if (back.agrees) return texel;
#if defined(HAS_SECOND) && defined(HAS_SECOND_DEPTH)
    known = known_behind(moment, sight, back.found, here);
#endif
    float beyond = texelFetch(surface, texel, 0).r;
    vec2 best = offset_at(moment, sight, max(beyond, 0.0));
    bool sound = beyond >= 0.0 && back.found >= 0.0 && (beyond < back.found || distance(best, back.better) < kAgree_px);
    return sound ? texel : texel_at(here + offset_at(moment, sight, own));
}
#endif

void main() {
    ivec2 p = ivec2(gl_FragCoord.xy);
    out_color = texelFetch(color, p, 0);
    float own = texelFetch(surface, p, 0).r;
    vec2 span = shutter_span();
    if (!camera_moves() || span.y <= span.x || param.max_blur <= 0.0 || own < 0.0) return;

    Motion motion = camera_motion();
    Sight sight = sight_of(gl_FragCoord.xy);
    vec2 path = offset_at(moment_at(motion, sight, span, span.y), sight, own) -
                offset_at(moment_at(motion, sight, span, span.x), sight, own);
    float spread = param.jitter * clamp(length(path) / float(param.samples) - 1.0, 0.0, 1.0);
    float phase = 0.5 + spread * (random_phase() - 0.5);
    // Samples lie up to half a pixel beside the path, so that nearest texels come to what a linear filter across it gives.
    vec2 across = vec2(-path.y, path.x) / max(length(path), 1.0);
#if OCCLUSION
    float nearest = max(texelFetch(near, p / kTile, 0).r, own);
#endif

    vec4 sum = vec4(0.0);
    float count = 0.0;
    for (int i = 0; i < param.samples; ++i) {
        float t = mix(span.x, span.y, (float(i) + phase) / float(param.samples));
        Moment moment = moment_at(motion, sight, span, t);
        vec2 here = sight.px + across * (fract(0.5 + 0.618034 * float(i)) - 0.5);
#if OCCLUSION
        vec4 known;
        ivec2 texel = visible(moment, sight, own, nearest, here, known);
        if (known.a > 0.0) {
            sum += known;
            count += 1.0;
            continue;
        }
#else
        ivec2 texel = texel_at(here + offset_at(moment, sight, own));
#endif
        if (texelFetch(surface, texel, 0).r < 0.0) continue;
        sum += texelFetch(color, texel, 0);
        count += 1.0;
    }
    if (count > 0.0) out_color = sum / count;
}
