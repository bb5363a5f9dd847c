// What is seen at a point at one time of the exposure is what comes there: a pixel whose path leads to it. One is sought
// from the pixel's own motion and one from that of the furthest moving thing around; the nearer one hides the other.

struct Found {
    vec2 from;     // where it is at the frame's own time
    float depth_m;
    float share;   // 1 where its path leads to the point, 0 where it misses it by more than a px
};

// `path`: a first guess of its path. The motion found there is the next guess.
Found what_comes(vec2 point, vec4 path, float t) {
    vec2 from = point - way_px(motion_at(point - way_px(path, t)).path, t);
    Motion m = motion_at(from);
    float miss_px = distance(vec2(texel_at(from)) + 0.5 + way_px(m.path, t), point);
    return Found(from, m.depth_m, clamp(1.5 - miss_px, 0.0, 1.0));
}

vec4 through_shutter(ivec2 p, vec2 point, Motion own, vec4 furthest) {
    int taps = tap_count(furthest);
    float shift = time_shift(p, furthest, taps);
    vec4 sum = vec4(0.0);
    for (int i = 0; i < taps; ++i) {
        float t = tap_time(i, shift, taps);
        Found near = what_comes(point, furthest, t), far = what_comes(point, own.path, t);
        if (far.depth_m < near.depth_m) {
            Found swap = near;
            near = far;
            far = swap;
        }
        // Where nothing comes, the thing here has moved away from what the frame does not show: what lies where it comes
        // from continues behind it.
        float rest = 1.0 - near.share, uncovered = rest * (1.0 - far.share);
        vec2 behind = uncovered > 0.5 * rest ? point - way_px(own.path, t) : far.from;
        if (near.share > 0.0) sum += near.share * color_at(near.from);
        if (rest > 0.0) sum += rest * color_at(behind);
    }
    return sum / float(taps);
}
