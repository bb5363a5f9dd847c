#version 450 core
#include <pass>
#include "slices.glsl"
#include "layers.glsl"

layout(local_size_x = 1) in;

// A quad for each pixel of each layer and for each beyond the edges that reaches the picture.
void main() {
    ivec2 size = ivec2(color_size.xy) + 2 * margin_px(texelFetch(range, ivec2(0), 0).rg);
    splats[0] = 4u;
    splats[1] = layer_count() * uint(size.x * size.y);
    splats[2] = 0u;
    splats[3] = 0u;
}
