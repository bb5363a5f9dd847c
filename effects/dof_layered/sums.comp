#version 450 core
#include <pass>
#include "layers.glsl"

layout(local_size_x = 1, local_size_y = 64) in;

shared uint any_share;

// One invocation sums one row of a tile: with sums that start anew every 64 px, 32-bit floats keep a uniform image uniform.
void main() {
    if (gl_LocalInvocationIndex == 0u) any_share = 0u;
    barrier();
    Layers layers = make_layers(texelFetch(range, ivec2(0), 0).rg);
    ivec2 size = ivec2(color_size.xy);
    int y = int(gl_GlobalInvocationID.y), left = int(gl_WorkGroupID.x) * kTile;
    int end = y < size.y ? min(left + kTile, size.x) : left;
    vec4 light = vec4(0.0);
    vec2 share = vec2(0.0);
    for (int x = left; x < end; ++x) {
        float behind = float(pass.index) - layer_of(layers, texelFetch(coc, ivec2(x, y), 0).r);
        float seen = seen_in(behind), hidden = hidden_in(behind);
        if (seen > 0.0) light += seen * texelFetch(color, ivec2(x, y), 0);
        share += vec2(seen, seen_from(behind));
        if (hidden > 0.0) {
            vec3 at = vec3((vec2(x, y) + 0.5) * color_size.zw, float(pass.index));
            light += hidden * textureLod(hidden_light, at, 0.0);
            share += hidden * textureLod(hidden_share, at, 0.0).rg;
        }
        imageStore(sums, ivec3(x, y, pass.index), light);
        imageStore(shares, ivec3(x, y, pass.index), vec4(share, 0.0, 0.0));
    }
    if (share.x > 0.0) any_share = 1u;
    barrier();
    if (gl_LocalInvocationIndex == 0u)
        imageStore(occupied, ivec3(gl_WorkGroupID.xy, pass.index), vec4(float(any_share)));
}
