// Pixels along the furthest motion around: those in front count where their own way reaches the point, those behind where
// the point's way reaches them. What is missing is filled with the mean of what lies behind.

vec4 through_shutter(ivec2 p, vec2 point, Motion own, vec4 furthest) {
    float own_way_px = longest_way_px(own.path);
    int taps = tap_count(furthest);
    float shift = time_shift(furthest, taps);
    vec4 sum = vec4(0.0), behind = vec4(0.0);
    float weight = 0.0, behind_weight = 0.0;
    int i = 0;
    do {
        vec2 offset = -way_px(furthest, tap_time(i, shift, taps));
        Motion tap = motion_at(point + offset);
        float tap_way_px = longest_way_px(tap.path);
        vec4 tap_color = color_at(point + offset);
        float front = clamp(0.5 + nearness(tap.depth_m, own.depth_m), 0.0, 1.0), away_px = length(offset);
        float front_share = front * clamp(tap_way_px - away_px + 1.0, 0.0, 1.0);
        float back_share = (1.0 - front) * clamp(own_way_px - away_px + 1.0, 0.0, 1.0);
        sum += (front_share + back_share) * tap_color;
        weight += front_share + back_share;
        behind += back_share * tap_color;
        behind_weight += back_share;
    } while (++i < taps);
    vec4 fill = behind_weight > 0.01 ? behind / behind_weight : texelFetch(color, p, 0);
    weight /= float(taps);
    return sum / float(taps) / max(weight, 1.0) + fill * max(1.0 - weight, 0.0);
}
