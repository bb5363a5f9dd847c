// Gathers at one point what the lens spreads over it, from `light` or a coarse level of it. Lengths in px of that level; CoC differences
// in px at full size. SILHOUETTES: in tiles where a surface lies clearly in front of another; elsewhere nothing is hidden, and software
// GL, which runs both sides of a branch, is spared what follows from it.
#include "loads.glsl"
#include "plate.glsl"
#include "levels.glsl"

struct Layer {
    vec4 color;     // premultiplied by opacity
    float opacity;
    vec2 hides;     // opacity of what lies in front of the visible surface, and of that with the surface itself
};

const Layer kNothing = Layer(vec4(0.0), 0.0, vec2(0.0));

struct Back {
    vec4 color;   // of the own surface over what is behind it
    float share;  // of the own surface
};

// Which taps count in front of a point: blurs too narrow for half size, the wider ones, or all.
const int kNarrow = 0, kWide = 1, kAll = 2;

// In a coarse level, what is in focus would leak into the texel beside it.
float part_of(int which, float coc, bool is_coarse) {
    float wide = clamp(abs(coc) - kFullSizePx + 1.0, 0.0, 1.0), blurred = is_coarse ? clamp(2.0 * abs(coc) - 1.0, 0.0, 1.0) : 1.0;
    return which == kAll ? blurred : which == kWide ? wide : 1.0 - wide;
}

// Bilinear interpolation between texels of half size widens a blur: at the pixels, all a quarter of a texel off, by a variance of
// 0.75 px squared along each axis. A hexagon's own is 5 / 24 of its circumradius squared, so that by variance its radius must be 1.8 px
// squared over the radius less. Nearest to the lens is 1.6 (moving_box). Texels of a quarter of the size are interpolated twice, first
// with four times the variance, which makes 8. In front of a point the widest blur stands for all.
// This is for what covers something else; a light on its own surface would become too small.
#if defined(QUARTER_SIZE)
float shrink_px(float radius_px) { return 8.0 / max(radius_px, kHalfSizePx); }
#elif defined(HALF_SIZE)
float shrink_px(float radius_px) { return 1.6 / max(radius_px, kFullSizePx); }
#else
float shrink_px(float radius_px) { return 0.0; }
#endif

// A point, and what is asked of it.
struct Point {
    vec2 center_px;
    Light own;
    float visible_coc;  // of the surface that the point shows
    float reach_px;     // how far what is in front of it may reach it; negative: not asked for
    float widest_px;    // CoC radius of what may
    int which;
    float radius_px;    // of its own aperture; negative: not asked for
};

const float kNotAsked = -16.0;  // px; less than a texel of every level

struct Sums {
    vec4 front;
    float opacity;
    vec2 hides;
    float aperture, own;  // of the visible surface's own aperture, and of what covers it
    vec4 color;           // of the own surface and of what is behind it
    float weight, behind;
};

// In front of a point, by its own CoC.
void add_front(inout Sums sums, Point point, Light tap, vec2 offset, float texels_per_px, float shrink, bool is_coarse, bool is_reached) {
    float radius = abs(tap.coc) * texels_per_px - shrink, part = is_reached ? part_of(point.which, tap.coc, is_coarse) : 0.0;
    float spread = part * cover(radius, gauge(offset, tap.coc)) / spread_area(radius);
    float weight = in_front(tap.coc, point.own.coc) * spread;
    sums.front += weight * tap.color;
    sums.opacity += weight;
#ifdef SILHOUETTES
    float visible_coc = point.visible_coc;
    sums.hides += spread * vec2(in_front(tap.coc, visible_coc), in_front(tap.coc, min(visible_coc + 2.0 * kClear, point.own.coc)));
    float seen = is_reached ? cover(abs(visible_coc) * texels_per_px - shrink, gauge(offset, visible_coc)) : 0.0;
    sums.aperture += seen;
    sums.own += seen * part * in_front(tap.coc, point.own.coc);
#endif
}

// The point's own surface and what is behind it, each seen through the point's own aperture.
void add_back(inout Sums sums, Point point, Light tap, vec2 offset, float radius) {
    float weight = cover(radius, gauge(offset, point.own.coc));
    sums.behind += weight * in_front(point.own.coc, tap.coc);
    weight *= 1.0 - in_front(tap.coc, point.own.coc);
    sums.color += weight * tap.color;
    sums.weight += weight;
}

// First and last texel of a row that an outline of this radius may cover, and no further than `reach`. Empty where there is none.
ivec2 texels_of_row(vec2 center, int y, float reach, float radius) {
    float dy = float(y) + 0.5 - center.y;
    int half_width = int(ceil(sqrt(max(reach * reach - dy * dy, 0.0)))), middle = int(floor(center.x));
    vec2 covered = center.x - 0.5 + columns(radius, dy);
    bool is_in = y >= int(floor(center.y - reach)) && y <= int(floor(center.y + reach));
    return is_in ? ivec2(max(middle - half_width, int(ceil(covered.x))), min(middle + half_width, int(floor(covered.y)))) : ivec2(1 << 20, -(1 << 20));
}

// The loops over a disk test at their end: llvmpipe runs the body of the others once more, with every pixel masked. One texel is
// taken at least.
void add_taps(inout Sums sums, Point point, int level, bool is_coarse) {
    float texels_per_px = 1.0 / float(1 << level);
    vec2 center = point.center_px * texels_per_px;
    float front_reach = point.reach_px * texels_per_px + 0.5, radius = point.radius_px * texels_per_px;
    float shrink = shrink_px(point.reach_px) * texels_per_px;
    float widest = point.widest_px * texels_per_px, reach = max(max(front_reach, radius + 0.5), 0.0);
    Grid grid = grid_of(level);
    int y = int(floor(center.y - reach)), last = int(floor(center.y + reach));
    do {
        ivec2 reached = texels_of_row(center, y, front_reach, widest), seen = texels_of_row(center, y, radius + 0.5, radius);
        int x = min(reached.x, seen.x), end = max(reached.y, seen.y);
        do {
            Light tap = is_coarse ? tap_coarse(ivec2(x, y), grid) : tap_light(ivec2(x, y));
            vec2 offset = center - vec2(x, y) - 0.5;
            add_front(sums, point, tap, offset, texels_per_px, shrink, is_coarse, x >= reached.x && x <= reached.y);
#ifdef SILHOUETTES
            // The plate in place of what hides the point's surface and those behind it.
            if (tap.coc < point.own.coc - kClear) tap = is_coarse ? plate_coarse(ivec2(x, y), level, grid) : plate_tap(ivec2(x, y), tap);
#endif
            add_back(sums, point, tap, offset, radius);
        } while (++x <= end);
    } while (++y <= last);
}

// What lies in front of CoC radius `own.coc` spreads over the point as far as its own CoC reaches, thinned by that area. Where the
// visible surface hides that of `own.coc`, it covers at least as much of the point as of its own aperture, so that no slope of its CoC
// opens a gap.
Layer front_of(Sums sums, Point point) {
    float opacity = min(sums.opacity, 1.0);
    vec2 hides = vec2(0.0);
#ifdef SILHOUETTES
    bool is_hidden = point.visible_coc < point.own.coc - kClear;
    float least = is_hidden && sums.aperture > 0.0 ? sums.own / sums.aperture : 0.0;
    if (sums.opacity > 0.0) opacity = max(opacity, min(least, 1.0));
    hides = is_hidden ? min(sums.hides, vec2(opacity)) : vec2(opacity);
#else
    hides = vec2(opacity);
#endif
    return Layer(sums.front * (sums.opacity > 0.0 ? opacity / sums.opacity : 0.0), opacity, hides);
}

struct Gathered {
    Layer over;    // what lies in front
    Back surface;
};

// A coarse level may show neither the own surface nor what is behind it: then the point's own light is all there is.
Gathered gather(Point point, vec4 around_coc) {
    const float kLeastWeight = 1e-3;
    Sums sums = Sums(vec4(0.0), 0.0, vec2(0.0), 0.0, 0.0, kLeastWeight * point.own.color, kLeastWeight, 0.0);
    bool asks_front = point.reach_px >= 0.0, asks_back = point.radius_px >= 0.0;
    int front_level = level_for(max(point.reach_px, 1.0), around_coc), back_level = level_for(max(point.radius_px, 1.0), around_coc);
    if (!asks_back) back_level = front_level;
    if (!asks_front) front_level = back_level;
#ifdef SILHOUETTES
    if (point.visible_coc < point.own.coc - kClear) point.widest_px = max(point.widest_px, abs(point.visible_coc));
#endif
    // One loop serves both where their levels are the same. Of two loops one takes its taps from level 0 alone.
    int turn = 0, turns = front_level == back_level ? 1 : 2;
    if (asks_front || asks_back) do {
        Point now = point;
        int level = turn == 0 ? back_level : front_level;
        if (turns == 2 && turn == 0) now.reach_px = kNotAsked;
        if (turn == 1) now.radius_px = kNotAsked;
        if (level == 0) add_taps(sums, now, 0, false);
        else add_taps(sums, now, level, true);
    } while (++turn < turns);
    Layer over = kNothing;
    if (asks_front) over = front_of(sums, point);
    Back surface = Back(point.own.color, 1.0);
    if (asks_back) surface = Back(sums.color / sums.weight, 1.0 - sums.behind / sums.weight);
    return Gathered(over, surface);
}

// Both lie in front of one point, of other light.
Layer both(Layer a, Layer b) {
    Layer sum = Layer(a.color + b.color, a.opacity + b.opacity, a.hides + b.hides);
    float scale = 1.0 / max(sum.opacity, 1.0);
    return Layer(scale * sum.color, scale * sum.opacity, min(sum.hides, vec2(1.0)));
}

// Light and opacity must agree to the last bit for what is even to stay even, and opacity is stored as a half.
Light stored(Layer layer) {
    float opacity = unpackHalf2x16(packHalf2x16(vec2(layer.opacity))).x;
    return Light(layer.color * (layer.opacity > 0.0 ? opacity / layer.opacity : 0.0), opacity);
}
