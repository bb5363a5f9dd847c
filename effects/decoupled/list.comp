#version 450 core
#include <pass>
#include "row.glsl"

void main() {
    int row = int(gl_GlobalInvocationID.x);
    if (row >= frame.size.y) return;
    uint next = 0u;
    for (int i = 0; i < row; ++i) next += row_count[i];
    if (row == frame.size.y - 1) highlight_args[1] = next + row_count[row];
    if (row_count[row] == 0u) return;
    for (int x = 0; x < frame.size.x; ++x)
        if (has_highlight(ivec2(x, row))) highlight_list[next++] = uint(x + 65536 * row);
}
