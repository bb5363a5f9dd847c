// Gathers at one point what the lens spreads over it, from one level of `light`. Lengths in px of that level; CoC differences
// in px at full size. SILHOUETTES: in tiles where a surface lies clearly in front of another; elsewhere nothing is hidden, and software
// GL, which runs both sides of a branch, is spared what follows from it.
#include "taps.glsl"
#include "plate.glsl"
#include "levels.glsl"

// The loops over a disk test at their end: llvmpipe runs the body of the others once more, with every pixel masked. A row
// has one texel at least.
int half_width(float reach, float dy) { return int(ceil(sqrt(max(reach * reach - dy * dy, 0.0)))); }

struct Layer {
    vec4 color;     // premultiplied by opacity
    float opacity;
    vec2 hides;     // opacity of what lies in front of the visible surface, and of that with the surface itself
};

const Layer kNothing = Layer(vec4(0.0), 0.0, vec2(0.0));

// Which taps count in front of a point: blurs too narrow for half size, the wider ones, or all.
const int kNarrow = 0, kWide = 1, kAll = 2;

// In a coarse level, what is in focus would leak into the texel beside it.
float part_of(int which, float coc, int level) {
    float wide = clamp(abs(coc) - kFullSizePx + 1.0, 0.0, 1.0), blurred = level == 0 ? 1.0 : clamp(2.0 * abs(coc) - 1.0, 0.0, 1.0);
    return which == kAll ? blurred : which == kWide ? wide : 1.0 - wide;
}

// Bilinear interpolation between texels of half size widens a blur: at the pixels, all a quarter of a texel off, by a variance of
// 0.75 px squared along each axis. A hexagon's own is 5 / 24 of its circumradius squared, so that by variance its radius must be 1.8 px
// squared over the radius less. Nearest to the lens is 1.6 (moving_box). Here the widest blur stands for all.
#ifdef HALF_SIZE
float shrink_px(float radius_px) { return 1.6 / max(radius_px, kFullSizePx); }
#else
float shrink_px(float radius_px) { return 0.0; }
#endif

// What lies in front of CoC radius `coc` spreads over the point as far as its own CoC reaches, thinned by that area.
// visible_coc: of the surface that the point shows. Where it hides the surface of `coc`, it covers at least as much of the point as
// of its own aperture, so that no slope of its CoC opens a gap.
const float kNoReach = -0.5;  // px; one tap is taken, the least that the loops below can do
Layer gather_front(vec2 center, float coc, float visible_coc, float reach_px, int level, int which) {
    float texels_per_px = 1.0 / float(1 << level), reach = reach_px * texels_per_px + 0.5;
    float shrink = shrink_px(reach_px) * texels_per_px;
#ifdef SILHOUETTES
    bool hides = visible_coc < coc - kClear;
    float own_radius = abs(visible_coc) * texels_per_px - shrink, aperture_sum = 0.0, own_sum = 0.0;
#endif
    Layer front = kNothing;
    ivec2 low = ivec2(floor(center - reach)), high = ivec2(floor(center + reach));
    int y = low.y;
    do {
        float dy = float(y) + 0.5 - center.y;
        int width = half_width(reach, dy);
        int x = int(floor(center.x)) - width, end = int(floor(center.x)) + width;
        do {
            Light tap = tap_light(ivec2(x, y), level);
            vec2 offset = center - vec2(x, y) - 0.5;
            float radius = abs(tap.coc) * texels_per_px - shrink, part = part_of(which, tap.coc, level);
            float spread = part * cover(radius, gauge(offset, tap.coc)) / spread_area(radius);
            float weight = in_front(tap.coc, coc) * spread;
            front.color += weight * tap.color;
            front.opacity += weight;
#ifdef SILHOUETTES
            if (hides) {
                front.hides += spread * vec2(in_front(tap.coc, visible_coc), in_front(tap.coc, min(visible_coc + 2.0 * kClear, coc)));
                float seen = cover(own_radius, gauge(offset, visible_coc));
                aperture_sum += seen;
                own_sum += seen * part * in_front(tap.coc, coc);
            }
#endif
        } while (++x <= end);
    } while (++y <= high.y);
    float opacity = min(front.opacity, 1.0);
#ifdef SILHOUETTES
    float least = aperture_sum > 0.0 ? own_sum / aperture_sum : 0.0;
    if (front.opacity > 0.0) opacity = max(opacity, min(least, 1.0));
#endif
    front.color *= front.opacity > 0.0 ? opacity / front.opacity : 0.0;
    front.opacity = opacity;
#ifdef SILHOUETTES
    front.hides = hides ? min(front.hides, vec2(opacity)) : vec2(opacity);
#else
    front.hides = vec2(opacity);
#endif
    return front;
}

// Both lie in front of one point, of other light.
Layer both(Layer a, Layer b) {
    Layer sum = Layer(a.color + b.color, a.opacity + b.opacity, a.hides + b.hides);
    float scale = 1.0 / max(sum.opacity, 1.0);
    return Layer(scale * sum.color, scale * sum.opacity, min(sum.hides, vec2(1.0)));
}

struct Back {
    vec4 color;   // of the own surface over what is behind it
    float share;  // of the own surface
};

// The point's own surface and what is behind it, each seen through the point's own aperture, with the plate in place of what hides
// them. A coarse level may show neither: then the point's own light is all there is.
Back gather_back(vec2 center, Light point, int level) {
    const float kLeastWeight = 1e-3;
    float coc = point.coc;
    float texels_per_px = 1.0 / float(1 << level), radius = (abs(coc) - shrink_px(abs(coc))) * texels_per_px, reach = radius + 0.5;
    vec4 own = kLeastWeight * point.color, behind = vec4(0.0);
    float own_weight = kLeastWeight, behind_weight = 0.0;
    ivec2 low = ivec2(floor(center - reach)), high = ivec2(floor(center + reach));
    int y = low.y;
    do {
        float dy = float(y) + 0.5 - center.y;
        int width = half_width(reach, dy);
        int x = int(floor(center.x)) - width, end = int(floor(center.x)) + width;
        do {
            Light tap = tap_light(ivec2(x, y), level);
#ifdef SILHOUETTES
            if (tap.coc < coc - kClear) tap = plate_tap(ivec2(x, y), level, tap);
#endif
            float seen = cover(radius, gauge(center - vec2(x, y) - 0.5, coc));
            float further = seen * in_front(coc, tap.coc);
            float same = seen * (1.0 - in_front(tap.coc, coc)) - further;
            own += same * tap.color;
            own_weight += same;
            behind += further * tap.color;
            behind_weight += further;
        } while (++x <= end);
    } while (++y <= high.y);
    float sum = own_weight + behind_weight;
    return Back((own + behind) / sum, own_weight / sum);
}
