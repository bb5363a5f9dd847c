// With layers, what is seen at a moment is composited, each by its share of its pixel.
#include <composite.glsl>

struct Find {
    vec2 at;      // px from the pixel
    float per_m;  // 1 / depth
    bool agrees;
};

float share_at(ivec2 texel) {
#ifdef HAS_SHARE
    return texelFetch(share, texel, 0).r;
#else
    return 1.0;
#endif
}

void put(inout Light light, Guess guess, vec2 here) {
    ivec2 texel = texel_at(here + guess.better);
    float covers = share_at(texel);
    vec4 seen = texelFetch(color, texel, 0);
#ifdef HAS_SHARE
    if (covers < 1.0) seen = texelFetch(first, texel, 0);
#endif
    put_behind(light, seen, covers);
}

bool is_same(Guess guess, Find find) {
    float nearer = max(guess.found, find.per_m), farther = min(guess.found, find.per_m);
    return guess.agrees && distance(guess.better, find.at) < 1.0 && nearer <= kOneSurface * farther;
}

// What a layer behind has there, sought first at the depth `sought`.
Find find_behind(sampler2D layer_depth, Moment moment, Sight sight, float sought, vec2 here) {
    float found = inverse_depth(texelFetch(layer_depth, texel_at(here + offset_at(moment, sight, sought)), 0).r);
    vec2 at = offset_at(moment, sight, max(found, 0.0));
    found = inverse_depth(texelFetch(layer_depth, texel_at(here + at), 0).r);
    vec2 better = offset_at(moment, sight, max(found, 0.0));
    return Find(better, found, distance(better, at) < kAgree_px);
}

// Whether the layer shows something there, which may be one of the guesses already.
bool put_hidden(inout Light light, sampler2D layer, Find find, Guesses guesses, vec2 here) {
    vec4 hidden = texelFetch(layer, texel_at(here + find.at), 0);
    bool is_there = find.agrees && hidden.a > 0.0;
    if (is_there && !is_same(guesses.back, find) && !is_same(guesses.front, find)) put_behind(light, hidden, hidden.a);
    return is_there;
}

// A guess once more: on what recedes steeply it agrees late.
Guess again(Guess guess, Moment moment, Sight sight, vec2 here) {
    float found = texelFetch(surface, texel_at(here + guess.better), 0).r;
    vec2 better = offset_at(moment, sight, max(found, 0.0));
    bool agrees = found >= 0.0 && distance(better, guess.better) < kAgree_px;
    if (guess.agrees || !agrees) return guess;
    return Guess(better, found, true);
}

void add_composite(inout Gathered gathered, Moment moment, Sight sight, float own, float nearest, vec2 here) {
    Guesses guesses = guesses_at(moment, sight, own, nearest, here);
    ivec2 texel = visible(guesses, moment, sight, own, here);
    guesses.back = again(guesses.back, moment, sight, here);
    Guess back = guesses.back, front = guesses.front;
    Light light = Light(vec4(0.0), 1.0);
    if (guesses.is_front) put(light, front, here);
    if (back.agrees && !(guesses.is_front && is_same(front, Find(back.better, back.found, true)))) put(light, back, here);
    float sought = max(back.found, 0.0);
    bool is_known = put_hidden(light, second, find_behind(second_depth, moment, sight, sought, here), guesses, here);
#if defined(HAS_THIRD) && defined(HAS_THIRD_DEPTH)
    bool is_deeper = put_hidden(light, third, find_behind(third_depth, moment, sight, sought, here), guesses, here);
    is_known = is_known || is_deeper;
#endif
    bool is_fixed = texelFetch(surface, texel, 0).r < 0.0;
    if (!is_known && !is_fixed) put_behind(light, texelFetch(color, texel, 0), 1.0);
    if (is_fixed && light.left == 1.0) return;
    gathered.sum += light.sum;
    gathered.count += 1.0;
}

// Two loops, because most is found at a first look, and the first one's turns are then shorter: software GL takes all branches.
const int kTimes = 32;  // in one turn: bits of `open`
void add_layers(inout Gathered gathered, Gather gather, float own, float nearest) {
    int start = 0;
    do {
        uint open = 0u;  // moments that are to be composited
        int i = start, end = min(start + kTimes, param.samples);
        do {
            vec2 here = here_of(gather, i);
            Guesses guesses = guesses_at(moment_of(gather, i), gather.sight, own, nearest, here);
            ivec2 texel = texel_at(here + (guesses.is_front ? guesses.front.better : guesses.back.better));
            bool is_whole = (guesses.is_front || guesses.back.agrees) && share_at(texel) == 1.0;
            if (is_whole) add(gathered, texel);
            else open |= 1u << uint(i - start);
        } while (++i < end);
        while (open != 0u) {
            int late = start + findLSB(open);
            add_composite(gathered, moment_of(gather, late), gather.sight, own, nearest, here_of(gather, late));
            open &= open - 1u;
        }
        start = end;
    } while (start < param.samples);
}
