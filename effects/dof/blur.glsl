// Gathers at one point what the lens spreads over it, from one level of `light`. Lengths in px of that level; CoC differences
// in px at full size.
#include <lens/packing.glsl>
#include "outline.glsl"
#include "reach.glsl"

// Surfaces whose CoC radii differ by less are one, by more are two; between, both.
float in_front(float tap_coc, float coc) { return clamp(coc - tap_coc, 0.0, 1.0); }

Light tap_light(ivec2 texel, int level) {
    // Not textureSize, which llvmpipe answers for the level of the first of its lanes.
    ivec2 last = max(frame.size >> level, ivec2(1)) - 1;
    return unpack_light(texelFetch(light, clamp(texel, ivec2(0), last), level));
}

int half_width(float reach, float dy) { return int(ceil(sqrt(max(reach * reach - dy * dy, 0.0)))); }

struct Layer {
    vec4 color;     // premultiplied by opacity
    float opacity;
};

// What lies in front of CoC radius `coc` spreads over the point as far as its own CoC reaches, thinned by that area.
Layer gather_front(vec2 center, float coc, float reach_px, int level) {
    float texels_per_px = 1.0 / float(1 << level), reach = reach_px * texels_per_px + 0.5;
    Layer front = Layer(vec4(0.0), 0.0);
    ivec2 low = ivec2(floor(center - reach)), high = ivec2(floor(center + reach));
    for (int y = low.y; y <= high.y; ++y) {
        float dy = float(y) + 0.5 - center.y;
        int width = half_width(reach, dy);
        int end = int(floor(center.x)) + width;
        for (int x = int(floor(center.x)) - width; x <= end; ++x) {
            Light tap = tap_light(ivec2(x, y), level);
            float radius = abs(tap.coc) * texels_per_px;
            float gauge_to = gauge(center - vec2(x, y) - 0.5, tap.coc);
            float weight = in_front(tap.coc, coc) * cover(radius, gauge_to) / spread_area(radius);
            front.color += weight * tap.color;
            front.opacity += weight;
        }
    }
    front.color /= max(front.opacity, 1.0);
    front.opacity = min(front.opacity, 1.0);
    return front;
}

struct Back {
    vec4 color;   // of the own surface over what is behind it
    float share;  // of the own surface
};

// The point's own surface and what is behind it, each seen through the point's own aperture. A coarse level may show neither:
// then the point's own light is all there is.
Back gather_back(vec2 center, Light point, int level) {
    const float kLeastWeight = 1e-3;
    float coc = point.coc;
    float texels_per_px = 1.0 / float(1 << level), radius = abs(coc) * texels_per_px, reach = radius + 0.5;
    vec4 own = kLeastWeight * point.color, behind = vec4(0.0);
    float own_weight = kLeastWeight, behind_weight = 0.0;
    ivec2 low = ivec2(floor(center - reach)), high = ivec2(floor(center + reach));
    for (int y = low.y; y <= high.y; ++y) {
        float dy = float(y) + 0.5 - center.y;
        int width = half_width(reach, dy);
        int end = int(floor(center.x)) + width;
        for (int x = int(floor(center.x)) - width; x <= end; ++x) {
            Light tap = tap_light(ivec2(x, y), level);
            float seen = cover(radius, gauge(center - vec2(x, y) - 0.5, coc));
            float further = seen * in_front(coc, tap.coc);
            float same = seen * (1.0 - in_front(tap.coc, coc)) - further;
            own += same * tap.color;
            own_weight += same;
            behind += further * tap.color;
            behind_weight += further;
        }
    }
    float sum = own_weight + behind_weight;
    return Back((own + behind) / sum, own_weight / sum);
}
