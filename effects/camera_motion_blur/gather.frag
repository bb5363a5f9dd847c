#version 450 core
#include <pass>
#include <shutter/random_phase.glsl>
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

struct Guesses {
    Guess back, front;
    bool is_front;  // in front of the other
};

Guesses guesses_at(Moment moment, Sight sight, float own, float nearest, vec2 here) {
    Guess back = guess(moment, sight, own, here), front = guess(moment, sight, nearest, here);
    return Guesses(back, front, front.agrees && (!back.agrees || front.found > back.found));
}

// Of what lies at the pixel's own depth and what may come over it, the nearest that agrees. Where neither does, what was hidden
// comes out; what is known of it from one layer is the farther surface beside it.
ivec2 visible(Guesses guesses, Moment moment, Sight sight, float own, vec2 here) {
    Guess back = guesses.back;
    if (guesses.is_front) return texel_at(here + guesses.front.better);
    ivec2 texel = texel_at(here + back.better);
    if (back.agrees) return texel;
    float beyond = texelFetch(surface, texel, 0).r;
    vec2 best = offset_at(moment, sight, max(beyond, 0.0));
    bool sound = beyond >= 0.0 && back.found >= 0.0 && (beyond < back.found || distance(best, back.better) < kAgree_px);
    return sound ? texel : texel_at(here + offset_at(moment, sight, own));
}
#endif

struct Gathered {
    vec4 sum;
    float count;
};

void add(inout Gathered gathered, ivec2 texel) {
    if (texelFetch(surface, texel, 0).r < 0.0) return;
    gathered.sum += texelFetch(color, texel, 0);
    gathered.count += 1.0;
}

// Where a pixel looks, and when.
struct Gather {
    Motion motion;
    Sight sight;
    vec2 span;
    float phase;   // of the first moment, in moments
    vec2 across;
};

Moment moment_of(Gather g, int i) {
    float t = mix(g.span.x, g.span.y, (float(i) + g.phase) / float(param.samples));
    return moment_at(g.motion, g.sight, g.span, t);
}

vec2 here_of(Gather g, int i) { return g.sight.px + g.across * (fract(0.5 + 0.618034 * float(i)) - 0.5); }

#if OCCLUSION && defined(HAS_SECOND) && defined(HAS_SECOND_DEPTH)
#define KNOWS_LAYERS
#include "layers.glsl"
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

    Gathered gathered = Gathered(vec4(0.0), 0.0);
    Gather gather = Gather(motion, sight, span, phase, across);
#ifdef KNOWS_LAYERS
    add_layers(gathered, gather, own, nearest);
#else
    for (int i = 0; i < param.samples; ++i) {
        vec2 here = here_of(gather, i);
#if OCCLUSION
        Moment moment = moment_of(gather, i);
        add(gathered, visible(guesses_at(moment, sight, own, nearest, here), moment, sight, own, here));
#else
        add(gathered, texel_at(here + offset_at(moment_of(gather, i), sight, own)));
#endif
    }
#endif
    if (gathered.count > 0.0) out_color = gathered.sum / gathered.count;
}
