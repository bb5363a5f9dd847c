// Gathers at one point what the lens spreads over it, from a level of `light`. Lengths in px of that level; CoC differences
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

// In `hides` and `hides_quarter`, a texel for which nothing in front was gathered.
const vec2 kNotReached = vec2(-1.0);

struct Back {
    vec4 color;   // of the own surface over what is behind it
    float share;  // of the own surface
};

// Which taps count in front of a point: blurs too narrow for half size, the wider ones, or all.
const int kNarrow = 0, kWide = 1, kAll = 2;

// The part of a tap that counts, as a line over its CoC radius in px, cut to 0 and 1: slope and value at 0. In a coarse level, what is in
// focus would leak into the texel beside it.
vec2 part_of(int which, int level) {
    vec2 wide = vec2(1.0, 1.0 - kFullSizePx), narrow = vec2(-1.0, kFullSizePx), all = level > 0 ? vec2(2.0, -1.0) : vec2(0.0, 1.0);
    return which == kAll ? all : which == kWide ? wide : narrow;
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

// A point as the texels of one level see it; apothems in texels. What is not asked for has values by which its weights are 0.
struct Aim {
    vec2 center;
    float reach;                       // of all that is taken
    float apothem_per_px, shrink;      // of a tap, by its CoC radius
    vec2 part;                         // of a tap, by its CoC radius: slope and value at 0
    float front_coc, visible_coc;      // what lies in front of them counts
    float own_apothem, seen_apothem;   // of the apertures of the point's own and its visible surface
};

const float kBehindNothing = -10000.0;  // px

Aim aim_at(Point point, int level) {
    float texels_per_px = 1.0 / float(1 << level), apothem_per_px = aperture.inradius * texels_per_px;
    bool asks_front = point.reach_px >= 0.0;
    Aim aim;
    aim.center = point.center_px * texels_per_px;
    aim.reach = max(max(point.reach_px, point.radius_px), 0.0) * texels_per_px;
    aim.apothem_per_px = apothem_per_px;
    aim.shrink = shrink_px(point.reach_px) * apothem_per_px;
    aim.part = part_of(point.which, level);
    aim.front_coc = asks_front ? point.own.coc : kBehindNothing;
    aim.visible_coc = asks_front ? point.visible_coc : kBehindNothing;
    aim.own_apothem = point.radius_px * apothem_per_px;
    aim.seen_apothem = asks_front ? abs(point.visible_coc) * apothem_per_px - aim.shrink : -1.0;
    return aim;
}

float cover_apothem(float apothem, float gauge) { return clamp(apothem + 0.5 - gauge, 0.0, 1.0); }

// In front of a point, by its own CoC.
void add_front(inout Sums sums, Aim aim, Light tap, GaugeRow row, float dx) {
    float apothem = abs(tap.coc) * aim.apothem_per_px - aim.shrink, part = clamp(abs(tap.coc) * aim.part.x + aim.part.y, 0.0, 1.0);
    float spread = part * cover_apothem(apothem, gauge_apothem(row, dx, tap.coc)) / spread_area_apothem(apothem);
    float before = in_front(tap.coc, aim.front_coc), weight = before * spread;
    sums.front += weight * tap.color;
    sums.opacity += weight;
#ifdef SILHOUETTES
    float visible_coc = aim.visible_coc;
    sums.hides += spread * vec2(in_front(tap.coc, visible_coc), in_front(tap.coc, min(visible_coc + 2.0 * kClear, aim.front_coc)));
    float seen = cover_apothem(aim.seen_apothem, gauge_apothem(row, dx, visible_coc));
    sums.aperture += seen;
    sums.own += seen * part * before;
#endif
}

// The point's own surface and what is behind it, each seen through the point's own aperture.
void add_back(inout Sums sums, Aim aim, float own_coc, Light tap, GaugeRow row, float dx) {
    float weight = cover_apothem(aim.own_apothem, gauge_apothem(row, dx, own_coc));
    sums.behind += weight * in_front(own_coc, tap.coc);
    weight *= 1.0 - in_front(tap.coc, own_coc);
    sums.color += weight * tap.color;
    sums.weight += weight;
}

// A level of `light`, and of the clean plate.
struct Source {
    Grid light;
    PlateGrid plate;
};

// A row of texels: y in `light`, and in the clean plate of that level.
struct TapRow {
    int y, plate_y;
    GaugeRow gauge;
};

TapRow tap_row(int y, vec2 center, Source source) {
    int inside = clamp(y, 0, source.light.last.y);
    return TapRow(source.light.origin.y + inside, plate_row(inside, source.plate), gauge_row(center.y - float(y) - 0.5));
}

struct Tap {
    Light light, patched;
};

Tap tap_at(int x, TapRow row, Source source) {
    int inside = clamp(x, 0, source.light.last.x);
    Tap tap;
    tap.light = unpack_light(texelFetch(light, ivec2(source.light.origin.x + inside, row.y), 0));
#ifdef SILHOUETTES
    tap.patched = plate_of(inside, row.plate_y, source.plate, tap.light);
#endif
    return tap;
}

void add_tap(inout Sums sums, Aim aim, float own_coc, Tap tap, TapRow row, float dx) {
    add_front(sums, aim, tap.light, row.gauge, dx);
#ifdef SILHOUETTES
    // The plate in place of what hides the point's surface and those behind it.
    if (tap.light.coc < own_coc - kClear) tap.light = tap.patched;
#endif
    add_back(sums, aim, own_coc, tap.light, row.gauge, dx);
}

// Two rows a turn, and their texels before what is made of them: a processor then has the next loads under way (0.83 of the time). The
// loops test at their end: llvmpipe runs the body of the others once more, with every pixel masked. One texel is taken at least.
void add_taps(inout Sums sums, Point point, int level) {
    Aim aim = aim_at(point, level);
    Source source = Source(grid_of(level), plate_grid_of(level));
    int y = int(floor(aim.center.y - aim.reach - 0.5)), last = int(floor(aim.center.y + aim.reach + 0.5));
    do {
        TapRow a = tap_row(y, aim.center, source), b = tap_row(y + 1, aim.center, source);
        vec2 columns_a = columns(aim.reach, -a.gauge.dy), columns_b = columns(aim.reach, -b.gauge.dy);
        float middle = aim.center.x - 0.5;
        int x = int(ceil(middle + min(columns_a.x, columns_b.x))), end = int(floor(middle + max(columns_a.y, columns_b.y)));
        do {
            Tap tap_a = tap_at(x, a, source), tap_b = tap_at(x, b, source);
            float dx = aim.center.x - float(x) - 0.5;
            add_tap(sums, aim, point.own.coc, tap_a, a, dx);
            add_tap(sums, aim, point.own.coc, tap_b, b, dx);
        } while (++x <= end);
        y += 2;
    } while (y <= last);
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
    // One loop serves both where their levels are the same.
    int turn = 0, turns = front_level == back_level ? 1 : 2;
    if (asks_front || asks_back) do {
        Point now = point;
        if (turns == 2 && turn == 0) now.reach_px = kNotAsked;
        if (turn == 1) now.radius_px = kNotAsked;
        add_taps(sums, now, turn == 0 ? back_level : front_level);
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
