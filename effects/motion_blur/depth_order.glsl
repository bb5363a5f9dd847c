// Soft order of two depths: 1 where the first is in front by this fraction of its depth or more, 0.5 where both are alike.
const float kSoftDepth = 0.05;

float nearness(float depth_m, float than_m) {
    float a = 1.0 / depth_m, b = 1.0 / than_m;  // 0 for what is infinitely far
    return (a - b) / max(max(a, b) * kSoftDepth, 1e-12);
}
