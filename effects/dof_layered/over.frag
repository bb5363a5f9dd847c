#version 450 core
#include <pass>
#include "part.glsl"

void add(inout Part sum, Part part, float weight) {
    sum.light += weight * part.light;
    sum.share += weight * part.share;
}

Part sum_to(ivec2 p) {
    ivec3 texel = ivec3(p, pass.index);
    return Part(texelFetch(sums, texel, 0), texelFetch(shares, texel, 0).rg);
}

// Adds `weight` times the sum from the start of its run to an edge at `x` between or within pixels.
void add_to(inout Part sum, float x, int y, float weight) {
    int width = int(color_size.x), column = min(int(x), width - 1);
    float part = x - float(column);
    if (part > 0.0) add(sum, sum_to(ivec2(column, y)), weight * part);
    if (!starts_run(column, width)) add(sum, sum_to(ivec2(column - 1, y)), weight * (1.0 - part));
}

// The pixels of a row from `left` to `right`; beyond the picture, those at its edges, which are runs of their own or the
// start of one.
Part span_sum(float left, float right, int y) {
    float width = color_size.x, from = clamp(left, 0.0, width), to = clamp(right, 0.0, width);
    int last_column = int(width) - 1, first = min(int(from), last_column), last = min(int(to), last_column);
    Part sum = Part(vec4(0.0), vec2(0.0));
    add_to(sum, to, y, 1.0);
    add_to(sum, from, y, -1.0);
    for (int tile = first / kTile; tile < last / kTile; ++tile) add(sum, sum_to(ivec2(tile * kTile + kTile - 1, y)), 1.0);
    if (last == last_column && first < last && last % kTile != 0) add(sum, sum_to(ivec2(last - 1, y)), 1.0);
    float before = max(-left, 0.0) - max(-right, 0.0), after = max(right - width, 0.0) - max(left - width, 0.0);
    if (before > 0.0) add(sum, sum_to(ivec2(0, y)), before);
    if (after > 0.0) add(sum, sum_to(ivec2(last_column, y)), after);
    return sum;
}

// Less is what rounding leaves where the layer is in the run but not in the span; one pixel of the largest CoC has more.
const float kLeastOpacity = 1e-6;

bool anything_within(ivec2 p, int reach) {
    ivec2 last = ivec2(color_size.xy) - 1;
    ivec2 low = clamp(p - reach, ivec2(0), last) / kOccupied, high = clamp(p + reach, ivec2(0), last) / kOccupied;
    for (int y = low.y; y <= high.y; ++y)
        for (int x = low.x; x <= high.x; ++x)
            if (texelFetch(occupied, ivec3(x, y, pass.index), 0).r > 0.0) return true;
    return false;
}

// The layer through the lens. Its opacity is the ratio of two blurs (Knutsson and Westin 1993): of what the layer is and of
// what is known at its depth or behind it. So a surface that two layers share adds up to itself.
Part blurred_layer(ivec2 p, int reach) {
    Part sum = Part(vec4(0.0), vec2(0.0));
    for (int row = -reach; row <= reach; ++row) {
        vec3 span = texelFetch(spans, ivec2(row + 256, pass.index), 0).rgb;
        if (span.z == 0.0) continue;
        int y = clamp(p.y + row, 0, int(color_size.y) - 1);
        add(sum, span_sum(float(p.x) + 0.5 + span.x, float(p.x) + 0.5 + span.y, y), span.z);
    }
    return sum;
}

void main() {
    ivec2 p = ivec2(gl_FragCoord.xy);
    out_front = texelFetch(front, p, 0);
    out_open = texelFetch(open, p, 0).rg;
    Layers layers = make_layers(texelFetch(range, ivec2(0), 0).rg);
    if (out_open.r == 0.0 || pass.index >= layer_count(layers)) return;
    bool sharp = pass.index == layers.near_count;
    int reach = int(ceil(abs(layer_radius(layers, pass.index)) + 0.5));
    if (!anything_within(p, sharp ? 0 : reach)) return;

    Part part;
    if (sharp) part = part_at(p, layers);
    else part = blurred_layer(p, reach);
    if (part.share.x <= kLeastOpacity * part.share.y) return;
    float known = max(part.share.y, part.share.x);
    float opacity = part.share.x / known;
    out_front += out_open.r / known * part.light;
    out_open.g += out_open.r * opacity;
    out_open.r *= 1.0 - opacity;
    if (out_open.r < 0.0005) out_open.r = 0.0;
}
