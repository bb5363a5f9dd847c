#version 450 core
#include <pass>
#include "data.glsl"

void main() {
    ivec2 first = ivec2(gl_FragCoord.xy) * param.tile_size, end = min(first + param.tile_size, frame.size);
    vec2 way = vec2(0.0);
    float most = 0.0;
    int all_faults = 0;
    for (int y = first.y; y < end.y; ++y)
        for (int x = first.x; x < end.x; ++x) {
            vec4 data = data_at(ivec2(x, y));
            int faults = faults_of(data);
            all_faults |= faults;
            float size = amount_of(data);
            if (faults == 0 && size > most) {
                most = size;
                way = data.xy;
            }
        }
    out_longest = vec4(way, most, float(all_faults));
}
