#version 450 core
#include <pass>
#include "fronts.glsl"
#include "sent_from.glsl"

// A tap, and how much it spreads over a point.
struct Strongest {
    vec2 offset_px;
    float coc, weight;
};

// Beyond this many texels, every second one of every second row is looked at.
const float kDense = 8.0;

Strongest strongest_tap(Point point, int level) {
    Aim aim = aim_at(point, level);
    Grid grid = grid_of(level);
    float px = float(1 << level), middle = aim.center.x - 0.5;
    int step = aim.reach > kDense ? 2 : 1, y = int(floor(aim.center.y - aim.reach - 0.5)), last = int(floor(aim.center.y + aim.reach + 0.5));
    Strongest strongest = Strongest(vec2(0.0), 0.0, 0.0);
    do {
        GaugeRow row = gauge_row(aim.center.y - float(y) - 0.5);
        vec2 across = columns(aim.reach, -row.dy);
        int x = int(ceil(middle + across.x)), end = int(floor(middle + across.y));
        do {
            Light tap = tap_level(ivec2(x, y), grid);
            float dx = aim.center.x - float(x) - 0.5, apothem = abs(tap.coc) * aim.apothem_per_px;
            float spread = cover_apothem(apothem, gauge_apothem(row, dx, tap.coc)) / spread_area_apothem(apothem);
            float weight = in_front(tap.coc, aim.front_coc) * spread;
            if (weight > strongest.weight) strongest = Strongest(-px * vec2(dx, row.dy), tap.coc, weight);
            x += step;
        } while (x <= end);
        y += step;
    } while (y <= last);
    return strongest;
}

// A coarse texel has the surface that most of it shows, which may not lie in its middle.
vec2 pixel_of(Strongest tap, vec2 center_px, int level) {
    int side = 1 << level;
    ivec2 corner = ivec2(floor(center_px + tap.offset_px - 0.5 * float(side))), nearest = corner;
    float least = 1e9;
    for (int i = 0; i < side * side; ++i) {
        ivec2 p = corner + ivec2(i % side, i / side);
        float unlike_px = abs(texelFetch(lit_coc, clamp(p, ivec2(0), frame.size - 1), 0).r - tap.coc);
        nearest = unlike_px < least ? p : nearest;
        least = min(least, unlike_px);
    }
    return vec2(nearest) + 0.5;
}

// Gathers the light in front as compose.frag does, and finds where most of it comes from.
void main() {
    ivec2 p = ivec2(gl_FragCoord.xy);
#ifdef SILHOUETTES
    Light own = plate_at(p);
#else
    Light own = tap_light(p);
#endif
    vec2 center = vec2(p) + 0.5;
    vec4 around_coc = texelFetch(around, p / kTile, 0);
    float visible_coc = tap_light(p).coc;
    Front front = front_at(p, own, visible_coc, around_coc);
    if (front.reach_px >= kLeastBlurPx) prepare_outline_at(center);
    Layer over = whole(front, gather(Point(center, own, visible_coc, front.asked_px, front.which, kNotAsked), around_coc).over);
    out_foreground = vec4(over.color.rgb, over.opacity);
    out_sent_from = 0.0;
    if (over.opacity > 0.0) {
        int level = level_for(max(front.reach_px, 1.0), around_coc);
        Strongest tap = strongest_tap(Point(center, own, visible_coc, front.reach_px, kAll, kNotAsked), level);
        if (tap.weight > 0.0) out_sent_from = pack_sent(dot(over.color.rgb, vec3(1.0)), pixel_of(tap, center, level) - center);
        else out_foreground = vec4(0.0);  // of a rim, too thin to say where it comes from
    }
}
