#version 450 core
// Gives texels the value to which their texture is cleared, by its bits. The host defines WIPE_UINT for integer formats.
layout(std140, binding = 0) uniform WipeBlock {
    vec4 tile_grid_size;
    uvec4 value;
    int tile_side;
    int tiles_in_a_row;
};
#ifdef WIPE_UINT
layout(location = 0) out uvec4 result;
void main() { result = value; }
#else
layout(location = 0) out vec4 result;
void main() { result = uintBitsToFloat(value); }
#endif
