#version 450 core
#include <pass>
#include <scattering/by_index.glsl>
#include "tables.glsl"

// Light at a distance into the lit side of a straight edge of a shadow, for each channel by its own d: the profile's edge
// response, blurred by the edge's own width. The other side is 1 minus it.

const int kSamples = 96;
const float kCut = 4.0;  // standard deviations

float channel(ScatteringProfileRow row, int c, float x) {
    float light = scattering_profile_line(row, abs(x))[c];
    return x < 0.0 ? 1.0 - light : light;
}

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    int profile = at.y / kEdgeLines, line = at.y % kEdgeLines;
    ScatteringProfileRow row = profile_at(profile);
    int samples = profile >= profile_count() ? 0 : line == 0 ? 1 : kSamples;
    float width = edge_width(line), distance = edge_distance(at.x, width);
    vec3 sum = vec3(0.0);
    float all = 1e-30;
    for (int i = 0; i < samples; ++i) {
        float off = kCut * (2.0 * (float(i) + 0.5) / float(samples) - 1.0);
        float share = exp(-0.5 * off * off);
        vec3 x = (distance - off * width) * row.d;
        sum += share * vec3(channel(row, 0, x.r), channel(row, 1, x.g), channel(row, 2, x.b));
        all += share;
    }
    out_edge_table = vec4(sum / all, 1.0);
}
