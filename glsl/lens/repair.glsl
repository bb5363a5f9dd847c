// CoC radii at the edges of small lights. Needs lens.glsl and highlight.glsl.

const float kLeastShare = 0.02;  // of the light: less of it cannot be seen in a blur

struct Tap {
    float amount, coc;
    bool is_shared;  // by layers of the capture, which leave nothing to repair
};

Tap tap_at(ivec2 p, float at_infinity_px) {
#ifdef SHARES_PIXELS
    Surface surface = surface_at(p, at_infinity_px);
    return Tap(amount(surface.is_shared ? surface.color.rgb : texelFetch(color, p, 0).rgb), surface.coc, surface.is_shared);
#else
    return Tap(amount(texelFetch(color, p, 0).rgb), coc_at(p, at_infinity_px), false);
#endif
}

// Of 3 x 3 px: the brightest across an edge, and the darkest of the middle's own surface. The light came across if it is more than
// that surface has.
struct Crossing {
    Tap brightest;
    ivec2 place;
    bool came_across;
};

Crossing crossing_at(ivec2 p, Tap own, float at_infinity_px) {
    Crossing crossing = Crossing(own, p, false);
    float darkest = own.amount;
    ivec2 last = ivec2(color_size.xy) - 1;  // once: software GL fetches it anew wherever it stands
    // A compiler does not unroll loops from a place that varies; unrolled, these took three times as long to compile.
    ivec2 place = p - 1;
    do {
        place.x = p.x - 1;
        do {
            ivec2 q = clamp(place, ivec2(0), last);
            Tap tap = tap_at(q, at_infinity_px);
            if (abs(tap.coc - own.coc) <= kOneSurfacePx) {
                darkest = min(darkest, tap.amount);
            } else if (tap.amount > crossing.brightest.amount) {
                crossing.brightest = tap;
                crossing.place = q;
            }
        } while (++place.x <= p.x + 1);
    } while (++place.y <= p.y + 1);
    crossing.came_across = crossing.place != p && own.amount > max(1.4 * kHighlight * darkest, kLeastShare * crossing.brightest.amount);
    return crossing;
}

// An antialiased pixel at the edge of a small light has the light's colour but may have the background's depth, and would
// throw a large polygon around the light's own. Where all of a pixel's light came across such an edge, from what outshines the
// tile, it takes the CoC of the brightest neighbour on the other side. One or the other: a CoC in between is that of no surface.
// Light that came to that neighbour across an edge too, as to a wire in front of a lamp, is not the neighbour's.
float repaired_coc(ivec2 p, float at_infinity_px, float tile_amount) {
    Tap own = tap_at(p, at_infinity_px);
    if (own.is_shared) return own.coc;
    float coc = own.coc;
    // To the neighbour, and from there to its own. A loop from a place that varies: a second copy takes as long to compile.
    int turn = p.x < 0 ? 1 : 0;
    do {
        Crossing crossing = crossing_at(p, own, at_infinity_px);
        if (!crossing.came_across || (turn == 0 && crossing.brightest.amount <= kOutshinesTile * tile_amount)) break;
        own = crossing.brightest;
        p = crossing.place;
        coc = own.coc;
    } while (++turn < 2);
    return coc;
}
