#version 450 core
#include <pass>
#include <lens/packing.glsl>
#include <aperture.glsl>
#include <near_reach/tile.glsl>
#ifdef HAS_APERTURE
#include "picture.glsl"
#endif

const float kLeastBlurPx = 0.5;
const float kAlikePx = 0.5;  // standard deviation of the CoC radii that a mean may have

// Light gathered from one side of the centre.
struct Sum {
    vec4 light;  // premultiplied
    float weight;
};

// The part of a row of taps from which light of one CoC radius reaches the centre, px.
struct Span {
    float low, high;
    float rows;  // share of the row that the outline covers
};

// Offsets go from the centre to what lights it: against the way light spreads, so that a CoC in front of the focus plane
// sees the outline as it is, one behind it turned by 180 degrees.
vec2 rows_of(float coc) {
    vec2 ends = -coc * texelFetch(spans, ivec2(0), 0).zw;
    return vec2(min(ends.x, ends.y), max(ends.x, ends.y));
}

Span span_at(float y, float step_px, float coc, vec2 rows) {
    float low = max(y - 0.5 * step_px, rows.x), high = min(y + 0.5 * step_px, rows.y);
    if (low >= high) return Span(1e9, -1e9, 0.0);
    float at = -0.5 * (low + high) / coc;
    vec2 ends = -coc * texelFetch(spans, ivec2(clamp(int(512.0 * (at + 1.0)), 0, 1023), 0), 0).xy;
    return Span(min(ends.x, ends.y), max(ends.x, ends.y), (high - low) / step_px);
}

float cover(Span span, float x, float step_px) {
    float part = min(x + 0.5 * step_px, span.high) - max(x - 0.5 * step_px, span.low);
    return span.rows * clamp(part / step_px, 0.0, 1.0);
}

Light take(ivec2 texel, int level) {
#if SAMPLER == SAMPLER_MIPS
    if (level > 0) {
        // Sides that are no multiple of the texel's are divided evenly.
        ivec2 size = max(frame.size >> level, ivec2(1));
        ivec2 coarse = ivec2((vec2(texel) + 0.5) / vec2(frame.size) * vec2(size));
        vec3 sum = texelFetch(blurred_coc, coarse, level).rgb;
        vec2 mean = sum.yz / max(sum.x, 1e-6);
        if (sum.x > 0.999 && mean.y - mean.x * mean.x <= kAlikePx * kAlikePx + 1e-5 * mean.y)
            return Light(texelFetch(blurred, coarse, level), mean.x);
    }
#endif
    return unpack_light(texelFetch(light, texel, 0));
}

// What lies in front of the centre counts as far as its own CoC reaches, thinned by the area it covers; the rest is seen
// through the centre's own aperture. Returns how much of the tap is in front.
float add_tap(inout Sum front, inout Sum back, Light tap, Aperture a, float centre_coc, vec2 offset, float own_cover,
              float step_px) {
    float in_front = clamp(centre_coc - tap.coc, 0.0, 1.0);
    float back_weight = (1.0 - in_front) * own_cover;
    back.light += back_weight * tap.color;
    back.weight += back_weight;
    if (in_front == 0.0) return 0.0;
    float radius_px = abs(tap.coc);
    if (radius_px == 0.0) return in_front;
    float gauge_px = aperture_gauge(a, tap.coc < 0.0 ? offset : -offset);
    float reached = clamp((radius_px - gauge_px) * a.inradius / step_px + 0.5, 0.0, 1.0);
    float tap_area = step_px * step_px;
    float front_weight = in_front * reached * tap_area / max(a.area * radius_px * radius_px, tap_area);
#ifdef HAS_APERTURE
    front_weight *= passes_at(-offset / tap.coc) / max(texelFetch(passes_mean, ivec2(0), 0).r, 1e-6);
#endif
    front.light += front_weight * tap.color;
    front.weight += front_weight;
    return in_front;
}

#ifdef HAS_BEHIND
// Where the centre is near and out of focus, what it hides is seen past it.
Light farthest_at(ivec2 p, Light nearest) {
    Light other = unpack_light(texelFetch(behind, p, 0));
    return nearest.coc <= -kLeastBlurPx && other.color.a > 0.0 && other.coc > nearest.coc ? other : nearest;
}
#endif

vec4 gather(ivec2 p, Light centre, float near_px) {
    Aperture a = make_aperture(param.blades, param.curvature, radians(param.rotation));
    float extent_px = max(abs(centre.coc), near_px);
    float step_px = max(sqrt(a.area * extent_px * extent_px / float(param.taps)), 1.0);
    int level = 0;
#if SAMPLER == SAMPLER_MIPS
    // As far apart as texels of a level are, or some would count twice.
    level = int(ceil(log2(step_px) - 1e-4));
    step_px = float(1 << level);
#endif
    bool sharp = abs(centre.coc) < kLeastBlurPx;
    float own_coc = sharp ? kLeastBlurPx : centre.coc, near_coc = -max(near_px, kLeastBlurPx);
    vec2 own_rows = rows_of(own_coc), near_rows = rows_of(near_coc);
    int first_row = int(floor(min(own_rows.x, near_rows.x) / step_px + 0.5));
    int last_row = int(floor(max(own_rows.y, near_rows.y) / step_px + 0.5));

    ivec2 last = ivec2(light_size.xy) - 1;
    Sum front = Sum(vec4(0.0), 0.0), back = Sum(vec4(0.0), 0.0);
    for (int row = first_row; row <= last_row; ++row) {
        float y = float(row) * step_px;
        Span own = span_at(y, step_px, own_coc, own_rows), close = span_at(y, step_px, near_coc, near_rows);
        Sum row_front = Sum(vec4(0.0), 0.0), row_back = row_front;  // summed row by row to lose fewer bits
        int end = int(floor(max(own.high, close.high) / step_px + 0.5));
        for (int column = int(floor(min(own.low, close.low) / step_px + 0.5)); column <= end; ++column) {
            vec2 offset = vec2(float(column) * step_px, y);
            bool middle = row == 0 && column == 0;
            ivec2 texel = clamp(p + ivec2(floor(offset + 0.5)), ivec2(0), last);
            float own_cover = sharp ? (middle ? 1.0 : 0.0) : cover(own, offset.x, step_px);
#ifdef HAS_APERTURE
            if (own_cover > 0.0 && !sharp) own_cover *= passes_at(-offset / own_coc);
#endif
            Light tap = take(texel, sharp && middle ? 0 : level);
            float in_front = add_tap(row_front, row_back, tap, a, centre.coc, offset, own_cover, step_px);
#ifdef HAS_BEHIND
            // Through the centre's own aperture alone: what is hidden and in front of the centre as well is rare.
            Light hidden = unpack_light(texelFetch(behind, texel, 0));
            float hidden_weight = hidden.color.a > 0.0 && hidden.coc > tap.coc ? in_front * own_cover : 0.0;
            row_back = Sum(row_back.light + hidden_weight * hidden.color, row_back.weight + hidden_weight);
#endif
        }
        front = Sum(front.light + row_front.light, front.weight + row_front.weight);
        back = Sum(back.light + row_back.light, back.weight + row_back.weight);
    }
    if (back.weight <= 0.0) back = Sum(centre.color, 1.0);
    float opacity = min(front.weight, 1.0);
    return front.light / max(front.weight, 1.0) + back.light / back.weight * (1.0 - opacity);
}

void main() {
    ivec2 p = ivec2(gl_FragCoord.xy);
    Light centre = unpack_light(texelFetch(light, p, 0));
    float near_px = texelFetch(near, p / kTile, 0).r;
#ifdef HAS_BEHIND
    centre = farthest_at(p, centre);
#endif
    out_color = max(abs(centre.coc), near_px) < kLeastBlurPx ? texelFetch(color, p, 0) : gather(p, centre, near_px);
}
