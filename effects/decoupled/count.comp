#version 450 core
#include <pass>
#include "row.glsl"

void main() {
    int row = int(gl_GlobalInvocationID.x);
    if (row >= frame.size.y) return;
    uint count = 0u;
    for (int x = 0; x < frame.size.x; ++x)
        if (has_highlight(ivec2(x, row))) ++count;
    row_count[row] = count;
}
