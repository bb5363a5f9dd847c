#include "edges.glsl"

const float kLeastRadiusPx = 2.0;  // CoC radius of a surface that lets anything through

// Whether a pixel of this CoC may hide something.
bool may_hide(ivec2 p, float coc_px) { return abs(coc_px) >= kLeastRadiusPx && texelFetch(beyond, p / kBlock, 0).r > coc_px + kBehindPx; }
