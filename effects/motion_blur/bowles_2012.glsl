// What is seen at a point at one time of the exposure is what comes there: a pixel whose path leads to it. One is sought
// from the pixel's own motion and one from that of the furthest moving thing around; the nearer one hides the other.

struct Found {
    vec2 from;     // where it is at the frame's own time
    float depth_m;
    bool comes;    // its path leads to the point, within a px
};

// `path`: a first guess of its path. The motion found there is the next guess.
Found what_comes(vec2 point, vec4 path, float t) {
    vec2 from = point - way_px(path, t);
    Motion m = motion_at(from);
    float miss_px = distance(vec2(texel_at(from)) + 0.5 + way_px(m.path, t), point);
    return Found(point - way_px(m.path, t), m.depth_m, miss_px < 1.0);
}

// What lies behind the thing at the point. `beside` is where the pixel comes from that shows what is behind it now.
#if BACKGROUND == BACKGROUND_NEIGHBOURS
#include "neighbours.glsl"
#else
vec4 uncovered(vec2 point, vec2 beside, Motion own, float t, vec4 color_beside) { return color_beside; }
#endif

vec4 through_shutter(ivec2 p, vec2 point, Motion own, vec4 furthest) {
    int taps = tap_count(furthest);
    float shift = time_shift(furthest, taps);
    vec4 sum = vec4(0.0);
    for (int i = 0; i < taps; ++i) {
        float t = tap_time(i, shift, taps);
        Found near = what_comes(point, furthest, t), far = what_comes(point, own.path, t);
        if (far.depth_m < near.depth_m) {
            Found swap = near;
            near = far;
            far = swap;
        }
        // Where nothing comes, the thing here has moved away from what the frame does not show. What lies where it comes
        // from is beside that.
        vec2 beside = point - way_px(own.path, t);
        bool is_found = near.comes || far.comes;
        vec4 seen = color_at(near.comes ? near.from : far.comes ? far.from : beside);
        sum += is_found ? seen : uncovered(point, beside, own, t, seen);
    }
    return sum / float(taps);
}
