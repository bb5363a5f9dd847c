// The filter of Guertin et al. 2014, figure 8: taps in turns along the furthest motion around and along the pixel's own, and
// less for what moves across the direction of the taps.

const float kOwnWay = 1.5;    // px of own motion from which its direction counts: gamma of the paper
const float kOwnShare = 40.0;  // kappa: the share of the pixel itself falls with its motion

vec2 direction_of(vec4 path, vec2 instead) {
    vec2 sweep = way_px(path, kCloses) - way_px(path, kOpens);
    float length_px = length(sweep);
    return length_px > 1e-3 ? sweep / length_px : instead;
}

vec4 through_shutter(ivec2 p, vec2 point, Motion own, vec4 furthest) {
    float own_way_px = longest_way_px(own.path);
    int taps = tap_count(furthest);
    float shift = time_shift(furthest, taps);
    vec2 main_direction = direction_of(furthest, vec2(1.0, 0.0)), across = vec2(-main_direction.y, main_direction.x);
    vec2 own_direction = direction_of(own.path, across);
    across = dot(across, own_direction) < 0.0 ? -across : across;
    vec2 mixed = mix(across, own_direction, clamp((own_way_px - 0.5) / kOwnWay, 0.0, 1.0));
    own_direction = mixed / max(length(mixed), 1e-3);
    float weight = float(taps) / (kOwnShare * max(own_way_px, 0.5));
    vec4 sum = weight * texelFetch(color, p, 0);
    int i = 0;
    do {
        bool is_own = (i & 1) == 1;
        vec2 offset = -way_px(is_own ? own.path : furthest, tap_time(i, shift, taps));
        vec2 along = is_own ? own_direction : main_direction;
        Motion tap = motion_at(point + offset);
        float tap_way_px = longest_way_px(tap.path);
        float away_px = length(way_px(furthest, tap_time(i, shift, taps)));
        float own_turn = abs(dot(own_direction, along)), tap_turn = abs(dot(direction_of(tap.path, along), along));
        float share = soft_before(tap.depth_m, own.depth_m) * cone(away_px, tap_way_px) * tap_turn
                    + soft_before(own.depth_m, tap.depth_m) * cone(away_px, own_way_px) * own_turn
                    + 2.0 * cylinder(away_px, min(tap_way_px, own_way_px)) * max(own_turn, tap_turn);
        weight += share;
        sum += share * color_at(point + offset);
    } while (++i < taps);
    return sum / weight;
}
