#version 450 core
#include <pass>
#include "data.glsl"

const int kTile = 16;

void main() {
    ivec2 first = ivec2(gl_FragCoord.xy) * kTile, end = min(first + kTile, frame.size);
    float low = 3e38, high = -3e38;
    int all_faults = 0;
    for (int y = first.y; y < end.y; ++y)
        for (int x = first.x; x < end.x; ++x) {
            vec4 data = data_at(ivec2(x, y));
            int faults = faults_of(data);
            all_faults |= faults;
            float amount = amount_of(data);
            bool counts = faults == 0;
#if SHOW == SHOW_DEPTH
            counts = counts && amount > 0.0;
#endif
            if (counts) low = min(low, amount);
            if (counts) high = max(high, amount);
        }
    out_range_tile = vec4(low, high, float(all_faults), 0.0);
}
