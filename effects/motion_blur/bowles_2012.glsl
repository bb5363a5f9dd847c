// What is seen at a point at one time of the exposure is what comes there: a pixel whose path leads to it. One is sought
// from the motion of the furthest moving thing around and one from another (other_guess); the nearer one hides the other.
const float kSurePx = 0.25;  // between the last two guesses of a place, up to which they are one

struct Found {
    vec2 from;     // where it is at the frame's own time
    float depth_m;
    float share;   // of its pixel
    bool comes;    // its path leads to the point, within a px
    bool is_sure;  // where it is, there is no other thing
};

bool leads_to(vec2 point, vec2 from, vec4 path, float t) {
    return distance(vec2(texel_at(from)) + 0.5 + way_px(path, t), point) < 1.0;
}

// `path`: a first guess of its path. The motion found there is the next guess, and once more: where motion differs from point to
// point, as on what rolls, the first guess misses its rim.
Found what_comes(vec2 point, vec4 path, float t) {
    vec4 guess = motion_at(point - way_px(path, t)).path;
    vec2 from = point - way_px(guess, t);
    Motion m = motion_at(from);
    vec2 at = point - way_px(m.path, t), middle = vec2(texel_at(from)) + 0.5;
    vec2 off = at - middle, inside = clamp(off, -0.499, 0.499), turn = at - from;
    bool is_sure = off == inside || dot(turn, turn) < kSurePx * kSurePx;
    return Found(is_sure ? middle + inside : at, m.depth_m, m.share, dot(off, off) < 1.0, is_sure);
}

float amount(vec3 rgb) { return rgb.r + rgb.g + rgb.b; }

// The light at a place between pixels; that of the nearest one where the others outshine it or it outshines them: a light beside a
// thing has a path of its own, and would be dragged along.
vec4 light_at(sampler2D image, vec2 point) {
    const float kOutshines = 8.0;
    vec4 mixed = textureLod(image, point * picture_px, 0.0), nearest = texelFetch(image, texel_at(point), 0);
    vec2 weight = 1.0 - abs(fract(point) - 0.5);
    float share = weight.x * weight.y, all = amount(nearest.rgb);
    float own = all * max(1.0 - share, 1e-3), others = max(amount(mixed.rgb) - share * all, 0.0);  // times the others' share
    return max(own, others) > kOutshines * min(own, others) ? nearest : mixed;
}

vec4 light_at(vec2 point) { return light_at(picture, point); }

// The mean light of two places, or of one; `share`: of the second. As light_at, and that of the nearest pixels where the places are not beside
// each other.
vec4 light_of_two(vec2 a, vec2 b, float share) {
    const float kOutshines = 8.0, kApartPx = 1.5;
    vec2 middle = mix(a, b, share);
    ivec2 a_texel = texel_at(a), b_texel = texel_at(b);
    vec4 mixed = color_at(middle), own = mix(texelFetch(picture, a_texel, 0), texelFetch(picture, b_texel, 0), share);
    vec2 by_a = max(1.0 - abs(middle - 0.5 - vec2(a_texel)), 0.0), by_b = max(1.0 - abs(middle - 0.5 - vec2(b_texel)), 0.0);
    float known = by_a.x * by_a.y + (a_texel == b_texel ? 0.0 : by_b.x * by_b.y), amount_known = amount(own.rgb);
    float here = amount_known * max(1.0 - known, 1e-3), others = max(amount(mixed.rgb) - known * amount_known, 0.0);
    return dot(a - b, a - b) > kApartPx * kApartPx || max(here, others) > kOutshines * min(here, others) ? own : mixed;
}

float amount_at(vec2 point) { return amount(texelFetch(picture, texel_at(point), 0).rgb); }

// Where a pixel lies that shows what the thing at the point hides: from where it comes, or on its other side. What stands in front of
// the thing is not behind it, and a light that is seen on one side, or at the very edge, does not go on behind the thing.
vec2 beside_at(vec2 point, Motion own, float t) {
    const float kBeyondPx = 6.0, kOutshines = 4.0;
    vec2 way = way_px(own.path, t), here = point - way, there = point - way_px(own.path, -t);
    float here_m = depth_at(here), there_m = depth_at(there), behind_m = kInFront * own.depth_m;
    float here_amount = amount_at(here), there_amount = amount_at(there);
    bool is_here_behind = here_m > behind_m, is_there_behind = there_m > behind_m;
    bool is_there = is_here_behind && is_there_behind ? here_amount > kOutshines * there_amount : there_m > here_m;
    vec2 place = is_there ? there : here, beyond = place + (is_there ? way : -way) * kBeyondPx / max(length(way), 1e-3);
    bool is_lone = depth_at(beyond) > behind_m && (is_there ? there_amount : here_amount) > kOutshines * amount_at(beyond);
    bool is_in_front = kInFront * here_m < own.depth_m || here_amount > kOutshines * amount_at(point);
    vec2 nowhere = is_in_front ? point : here;
    return is_here_behind || is_there_behind ? (is_lone ? beyond : place) : nowhere;
}

// What lies behind the thing at the point. `beside` is where the pixel comes from that shows what is behind it now.
#if BACKGROUND == BACKGROUND_NEIGHBOURS
#include "neighbours.glsl"
#else
vec4 uncovered(vec2 point, vec2 beside, Motion own, float t, vec4 color_beside) { return color_beside; }
#endif

struct Finds {
    Found near, far;
};

Finds in_order(Found a, Found b) {
    if (a.depth_m <= b.depth_m) return Finds(a, b);
    return Finds(b, a);
}

// The pixel's own path; or that of the nearest thing around, which moves past what is faster and is found from no other path. The
// pixel is then found from the furthest path, which its own is more like.
vec4 other_guess(ivec2 tile, Motion own, vec4 furthest) {
    vec4 near = texelFetch(around_near, tile, 0);
    bool is_in_front = kInFront * texelFetch(around_depth, tile, 0).r < own.depth_m;
    return is_in_front && distance(own.path.xy, furthest.xy) < distance(near.xy, furthest.xy) ? near : own.path;
}

Finds finds_at(vec2 point, vec4 furthest, vec4 other, float t) {
    return in_order(what_comes(point, furthest, t), what_comes(point, other, t));
}

#ifdef KNOWS_LAYERS
#include "layers.glsl"
#else
Found first_of(Finds finds) {
    if (finds.near.comes && finds.near.is_sure) return finds.near;
    return finds.far;
}

// Of what comes, or of what lies behind the pixel's own thing.
vec4 light_of(Found seen, vec2 point, Motion own, float t) {
    bool is_seen = seen.comes && seen.is_sure;
    vec2 beside = beside_at(point, own, t);
    vec4 light = light_at(is_seen ? seen.from : beside);
    return is_seen ? light : uncovered(point, beside, own, t, light);
}

vec4 seen_at(vec2 point, vec4 furthest, vec4 other, Motion own, float t) {
    return light_of(first_of(finds_at(point, furthest, other, t)), point, own, t);
}
#endif

// Two loops, because most is found at a first look, and the first one's turns are then shorter: software GL takes all branches.
#if defined(CROWDED) || defined(KNOWS_LAYERS) || defined(VEILED)
#include "veil.glsl"

vec4 through_shutter(ivec2 p, vec2 point, Motion own, vec4 furthest) {
    int taps = tap_count(furthest);
    float shift = time_shift(furthest, taps);
    vec4 sum = vec4(0.0), other = other_guess(p / kTile, own, furthest), sender = path_of_sender(p);
    int start = 0;
    do {
        uint open = 0u;  // times at which a second look is due
        int i = start, end = min(start + kTimes, taps);
        do {
            float t = tap_time(i, shift, taps);
            Found seen = first_of(finds_at(point, furthest, other, t));
            if (seen.comes && seen.is_sure && seen.share == 1.0) sum += under_veil(light_at(seen.from), seen.from, point, sender, furthest, t);
            else open |= 1u << uint(i - start);
        } while (++i < end);
        while (open != 0u) {
            float t = tap_time(start + findLSB(open), shift, taps);
            sum += under_veil(seen_at(point, furthest, other, own, t), kNowhere, point, sender, furthest, t);
            open &= open - 1u;
        }
        start = end;
    } while (start < taps);
    return sum / float(taps);
}
#else
// The nearest thing around is the furthest moving one, or moves alike. What is found from that path is mostly what the pixel's own path
// leads to as well; unless it lies behind the pixel's own thing, which may hide it, it is not sought from there.
vec4 through_shutter(ivec2 p, vec2 point, Motion own, vec4 furthest) {
    Parts parts = parts_of(furthest, min(param.samples, kTimes));
    float hidden_m = kInFront * own.depth_m, from_px = parts.first_px;
    vec4 sum = vec4(0.0);
    uint open = 0u;  // parts for which a second look is due
    int i = 0, count = int(ceil((parts.length_px - parts.first_px) / parts.step_px));
    do {
        float border_px = from_px + parts.step_px, to_px = border_px + parts.step_px;
        float a_from_px = max(from_px, 0.0), a_to_px = min(border_px, parts.length_px), b_to_px = min(to_px, parts.length_px);
        float a_t = part_time(parts, 0.5 * (a_from_px + a_to_px)), b_t = part_time(parts, 0.5 * (border_px + b_to_px));
        Found a = what_comes(point, furthest, a_t), b = what_comes(point, furthest, b_t);
        bool has_b = i + 1 < count;
        bool is_a = a.comes && a.is_sure && a.depth_m <= hidden_m, is_b = has_b && b.comes && b.is_sure && b.depth_m <= hidden_m;
        float a_px = is_a ? a_to_px - a_from_px : 0.0, b_px = is_b ? b_to_px - border_px : 0.0, both_px = a_px + b_px;
        sum += both_px * light_of_two(is_a ? a.from : b.from, is_b ? b.from : a.from, b_px / max(both_px, 1e-6));
        open |= (uint(!is_a) | uint(has_b && !is_b) << 1) << uint(i);
        from_px = to_px;
        i += 2;
    } while (i < count);
    // Between the times of one slice its own thing moves by at most a px: one look does for all of them that are open. Tested at the
    // end, as the loops over parts are. In floats, because software GL divides whole numbers lane by lane.
    float slices_per_part = float(min(tap_count(own.path), count)) / float(count), parts_per_slice = 1.0 / slices_per_part;
    float last_lacks_px = parts.first_px + float(count) * parts.step_px - parts.length_px;
    do {
        const float kRounding = 1e-3;
        int first = findLSB(open);
        float slice = floor(float(first) * slices_per_part + kRounding);
        int end = int(ceil((slice + 1.0) * parts_per_slice - kRounding));
        uint now = open & (0xffffffffu >> uint(32 - end));
        float middle_px = parts.first_px + (0.5 * float(first + findMSB(now)) + 0.5) * parts.step_px;
        float at = part_time(parts, middle_px);
        vec4 light = light_of(what_comes(point, own.path, at), point, own, at);
        float lacks_px = float(now >> uint(count - 1) & 1u) * last_lacks_px - float(now & 1u) * parts.first_px;
        float share = float(bitCount(now)) * parts.step_px - lacks_px;
        sum += now == 0u ? vec4(0.0) : share * light;
        open &= ~now;
    } while (open != 0u);
    return sum * parts.each_px;
}
#endif
