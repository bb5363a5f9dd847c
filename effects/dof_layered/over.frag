#version 450 core
#include <pass>
#include "layers.glsl"

// Part of a layer: its light, its opacity, and how much is known about it.
struct Part {
    vec4 light;
    vec2 share;
};

void add(inout Part sum, Part part, float weight) {
    sum.light += weight * part.light;
    sum.share += weight * part.share;
}

Part sum_to(ivec2 p) { return Part(texelFetch(sums, ivec3(p, pass.index), 0), texelFetch(shares, ivec3(p, pass.index), 0).rg); }

// Adds `weight` times the sum from the start of the tile to an edge at `x` between or within pixels.
void add_to(inout Part sum, float x, int y, float weight) {
    int column = min(int(x), int(color_size.x) - 1);
    float part = x - float(column);
    if (part > 0.0) add(sum, sum_to(ivec2(column, y)), weight * part);
    if (column % kTile != 0) add(sum, sum_to(ivec2(column - 1, y)), weight * (1.0 - part));
}

// Adds the pixels of a row from `left` to `right`; beyond the picture, the pixels at its edge.
void add_span(inout Part sum, float left, float right, int y, float weight) {
    float width = color_size.x;
    float from = clamp(left, 0.0, width), to = clamp(right, 0.0, width);
    int first = min(int(from), int(width) - 1) / kTile, last = min(int(to), int(width) - 1) / kTile;
    add_to(sum, to, y, weight);
    add_to(sum, from, y, -weight);
    for (int tile = first; tile < last; ++tile) add(sum, sum_to(ivec2(tile * kTile + kTile - 1, y)), weight);
    float before = max(-left, 0.0) - max(-right, 0.0), after = max(right - width, 0.0) - max(left - width, 0.0);
    if (before > 0.0) add(sum, sum_to(ivec2(0, y)), weight * before);
    if (after > 0.0) {
        add_to(sum, width, y, weight * after);
        add_to(sum, width - 1.0, y, -weight * after);
    }
}

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
        add_span(sum, float(p.x) + 0.5 + span.x, float(p.x) + 0.5 + span.y, y, span.z);
    }
    return sum;
}

Part sharp_layer(ivec2 p, Layers layers) {
    float behind = float(pass.index) - layer_of(layers, texelFetch(coc, p, 0).r);
    if (behind == 0.0) return Part(texelFetch(color, p, 0), vec2(1.0));
    Part part = sum_to(p);
    if (p.x % kTile != 0) add(part, sum_to(p - ivec2(1, 0)), -1.0);
    return part;
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
    if (sharp) part = sharp_layer(p, layers);
    else part = blurred_layer(p, reach);
    if (part.share.x <= 0.0) return;
    float known = max(part.share.y, part.share.x);
    float opacity = part.share.x / known;
    out_front += out_open.r / known * part.light;
    out_open.g += out_open.r * opacity;
    out_open.r *= 1.0 - opacity;
    if (out_open.r < 0.0005) out_open.r = 0.0;
}
