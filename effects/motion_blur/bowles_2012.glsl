// What is seen at a point at one time of the exposure is what comes there: a pixel whose path leads to it. One is sought
// from the pixel's own motion and one from that of the furthest moving thing around; the nearer one hides the other.
const float kInFront = 1.03;  // times the depth of what is in front, from which on another thing is behind it

struct Found {
    vec2 from;     // where it is at the frame's own time
    float depth_m;
    bool comes;    // its path leads to the point, within a px
};

// `path`: a first guess of its path. The motion found there is the next guess, and once more: where motion differs from point to
// point, as on what rolls, the first guess misses its rim.
Found what_comes(vec2 point, vec4 path, float t) {
    vec4 guess = motion_at(point - way_px(path, t)).path;
    vec2 from = point - way_px(guess, t);
    Motion m = motion_at(from);
    float miss_px = distance(vec2(texel_at(from)) + 0.5 + way_px(m.path, t), point);
    return Found(point - way_px(m.path, t), m.depth_m, miss_px < 1.0);
}

float amount(vec3 rgb) { return rgb.r + rgb.g + rgb.b; }

// The light at a place between pixels; that of the nearest one where the others outshine it or it outshines them: a light beside a
// thing has a path of its own, and would be dragged along.
vec4 light_at(vec2 point) {
    const float kOutshines = 8.0;
    vec4 mixed = color_at(point), nearest = texelFetch(color, texel_at(point), 0);
    vec2 weight = 1.0 - abs(fract(point) - 0.5);
    float share = weight.x * weight.y, own = amount(nearest.rgb);
    float others = max(amount(mixed.rgb) - share * own, 0.0) / max(1.0 - share, 1e-3);
    return max(own, others) > kOutshines * min(own, others) ? nearest : mixed;
}

// Where a pixel lies that shows what the thing at the point hides: from where it comes, or on its other side, if a light is seen
// there that is none here. What stands in front of the thing is not behind it.
vec2 beside_at(vec2 point, Motion own, float t) {
    const float kOutshines = 4.0;
    vec2 here = point - way_px(own.path, t), there = point - way_px(own.path, -t);
    float here_m = motion_at(here).depth_m, there_m = motion_at(there).depth_m, behind_m = kInFront * own.depth_m;
    if (here_m > behind_m && there_m > behind_m)
        return amount(color_at(here).rgb) > kOutshines * amount(color_at(there).rgb) ? there : here;
    if (here_m > behind_m || there_m > behind_m) return here_m > there_m ? here : there;
    return kInFront * here_m < own.depth_m ? point : here;
}

#include "known.glsl"

// What lies behind the thing at the point. `beside` is where the pixel comes from that shows what is behind it now.
#if BACKGROUND == BACKGROUND_NEIGHBOURS
#include "neighbours.glsl"
#else
vec4 uncovered(vec2 point, vec2 beside, Motion own, float t, vec4 color_beside) { return color_beside; }
#endif

vec4 behind_at(vec2 point, vec2 beside, Motion own, float t, vec4 color_beside) {
#ifdef KNOWS_BEHIND
    vec4 known = known_behind(point, motion_at(beside).path, t);
    if (known.a > 0.0) return known;
#endif
    return uncovered(point, beside, own, t, color_beside);
}

vec4 through_shutter(ivec2 p, vec2 point, Motion own, vec4 furthest) {
    int taps = tap_count(furthest);
    float shift = time_shift(furthest, taps);
    vec4 sum = vec4(0.0);
    int i = 0;
    do {
        float t = tap_time(i, shift, taps);
        Found near = what_comes(point, furthest, t), far = what_comes(point, own.path, t);
        if (far.depth_m < near.depth_m) {
            Found swap = near;
            near = far;
            far = swap;
        }
        // Where nothing comes, the thing here has moved away from what the frame does not show.
        vec2 beside = beside_at(point, own, t);
        bool is_found = near.comes || far.comes;
        vec4 seen = light_at(near.comes ? near.from : far.comes ? far.from : beside);
        if (!is_found) seen = behind_at(point, beside, own, t, seen);
        sum += seen;
    } while (++i < taps);
    return sum / float(taps);
}
