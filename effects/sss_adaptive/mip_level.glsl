// Widest mean, 32 px: beyond it light of other surface would come in.
const float kMostLevel = 5.0;

// Level whose texels are a quarter as large as the area that a sample stands for (Krivanek and Colbert 2008), px^2, which is 4
// to the level. Of the whole area the head of docs/quality-sss-adaptive.md came out 3 dB worse: too much blur for 3 % fewer samples.
float mip_level(float area_px) { return clamp(0.5 * log2(0.25 * area_px), 0.0, kMostLevel); }
