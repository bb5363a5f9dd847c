// Widest mean, 32 px: beyond it light of other surface would come in.
const float kMostLevel = 5.0;

// Level whose texels are about as large as the area that a sample stands for (Krivanek and Colbert 2008), px^2, which is 4
// to the level.
float mip_level(float area_px) { return clamp(0.5 * log2(area_px), 0.0, kMostLevel); }
