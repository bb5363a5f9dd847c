#include "outline.glsl"
#include "patch_texels.glsl"
#include "reach.glsl"

// Surfaces whose CoC radii differ by less are one, by more are two; between, both.
float in_front(float tap_coc, float coc) { return clamp(coc - tap_coc, 0.0, 1.0); }
