// Up to kFullSizePx the blur is gathered at full size; beyond, at half size from the finest level whose texels are at most
// kTexels a radius: about pi times its square are fetched.
#if QUALITY == QUALITY_FAST
const float kFullSizePx = 4.0, kTexels = 8.0;
#elif QUALITY == QUALITY_NORMAL
const float kFullSizePx = 8.0, kTexels = 16.0;
#else
const float kFullSizePx = 64.0, kTexels = 64.0;
#endif

int level_for(float radius_px) { return clamp(int(ceil(log2(radius_px / kTexels))), 0, 3); }
