// Texels of `patches` and `plate`.
#include <lens/packing.glsl>

// CoC radius where nothing is hidden: infinity as a half.
const uvec4 kNoPatch = uvec4(0u, 0u, 0u, 0x7c000000u);
bool is_patch(Light texel) { return texel.coc < kHalfInfinity; }

// In `plate` no patch is 0, which is what new memory holds on software GL: a first frame need not clear it.
uvec4 pack_plate(uvec4 patched) { return patched ^ kNoPatch; }
Light unpack_plate(uvec4 texel) { return unpack_light(texel ^ kNoPatch); }
