#version 450 core
#include <pass>
#include "path.glsl"

const int kTile = 16;

void main() {
    ivec2 last = ivec2(surface_size.xy) - 1;
    ivec2 corner = ivec2(gl_FragCoord.xy) * kTile;
    float nearest = -1.0;
    for (int y = 0; y < kTile; ++y)
        for (int x = 0; x < kTile; ++x)
            nearest = max(nearest, texelFetch(surface, min(corner + ivec2(x, y), last), 0).r);
    out_tile = nearest;
    out_tile_reach = vec4(0.0);
    vec2 span = shutter_span();
    if (nearest <= 0.0 || span.y <= span.x) return;
    // Where it goes is the other way than where a pixel finds it.
    Motion motion = camera_motion();
    Sight sight = sight_of(vec2(corner) + 0.5 * float(kTile));
    vec2 a = -offset_at(moment_at(motion, sight, span, span.x), sight, nearest);
    vec2 b = -offset_at(moment_at(motion, sight, span, span.y), sight, nearest);
    // Within a tile the motion differs a little.
    vec2 margin = 2.0 + 0.1 * abs(a - b);
    out_tile_reach = vec4(min(min(a, b), 0.0) - margin, max(max(a, b), 0.0) + margin);
}
