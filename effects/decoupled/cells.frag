#version 450 core
#include <pass>
#include "cells.glsl"
#include "key.glsl"
#include "path.glsl"

void main() {
    ivec2 cell = ivec2(gl_FragCoord.xy);
    int time = cell.y / kCells;
    vec2 point = (vec2(cell.x, cell.y % kCells) + 0.5) * (2.0 / float(kCells)) - 1.0;
    float t = kOpens + (float(time) + 0.5) / float(kTimes), weight = time == kTimes ? 0.0 : 4.0, nearest = 1e9;
    uint found = 0u;
    for (int s = 0; s < min(param.samples, kBandSamples); ++s) {
        vec3 tap = texelFetch(points, ivec2(s, 0), 0).xyz;
        vec2 apart = tap.xy - point;
        float distance_2 = dot(apart, apart) + weight * (tap.z - t) * (tap.z - t);
        if (distance_2 < nearest) {
            nearest = distance_2;
            found = uint(s);
        }
    }
    out_cells = found;
}
