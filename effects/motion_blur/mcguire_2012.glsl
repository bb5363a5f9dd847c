// The filter of McGuire et al. 2012, figure 4: pixels along the furthest motion around.

vec4 through_shutter(ivec2 p, vec2 point, Motion own, vec4 furthest) {
    float own_way_px = longest_way_px(own.path);
    int taps = tap_count(furthest);
    float shift = time_shift(furthest, taps);
    float weight = 1.0 / max(own_way_px, 0.5);
    vec4 sum = weight * texelFetch(color, p, 0);
    int i = 0;
    do {
        vec2 offset = -way_px(furthest, tap_time(i, shift, taps));
        Motion tap = motion_at(point + offset);
        float tap_way_px = longest_way_px(tap.path);
        float away_px = length(offset);
        float share = soft_before(tap.depth_m, own.depth_m) * cone(away_px, tap_way_px)
                    + soft_before(own.depth_m, tap.depth_m) * cone(away_px, own_way_px)
                    + 2.0 * cylinder(away_px, min(tap_way_px, own_way_px));
        weight += share;
        sum += share * color_at(point + offset);
    } while (++i < taps);
    return sum / weight;
}
