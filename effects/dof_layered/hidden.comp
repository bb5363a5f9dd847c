#version 450 core
#include <pass>
#include "layers.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

// Pulls from ever coarser levels until something behind the layer's own depth is seen.
void main() {
    ivec2 texel = ivec2(gl_GlobalInvocationID.xy), size = imageSize(hidden_light).xy;
    if (any(greaterThanEqual(texel, size))) return;
    if (pass.index >= layer_count(make_layers(texelFetch(range, ivec2(0), 0).rg))) return;
    vec3 at = vec3((vec2(texel) + 0.5) / vec2(size), float(pass.index));
    int levels = textureQueryLevels(seen_share);
    vec4 light = vec4(0.0);
    vec2 share = vec2(0.0);
    float missing = 1.0;
    for (int level = 0; level < levels && missing > 0.001; ++level) {
        vec2 here = textureLod(seen_share, at, float(level)).rg;
        light += missing * textureLod(seen_light, at, float(level));
        share += missing * here;
        missing *= 1.0 - min(4.0 * here.y, 1.0);
    }
    bool known = share.y > 1e-8;
    imageStore(hidden_light, ivec3(texel, pass.index), known ? light / share.y : vec4(0.0));
    imageStore(hidden_share, ivec3(texel, pass.index), known ? vec4(share.x / share.y, 1.0, 0.0, 0.0) : vec4(0.0));
}
