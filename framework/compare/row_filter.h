// The inner loops of FLIP and SSIM over one row, each compiled for AVX2 too and chosen at run time. Without
// fused multiply-add both give the same bits.
#pragma once

#include <span>

namespace aftershade::rows {

/// Rows are allocated as multiples of this many values, so that loops need no remainder.
inline constexpr int kLanes = 16;
constexpr int padded(int width) {
    return (width + kLanes - 1) / kLanes * kLanes;
}

/// Rows that a thread filters together: high enough that the rows filtered twice, at the borders of bands,
/// are few; low enough to share work.
inline constexpr int kBandHeight_px = 64;

/// out[x] = sum of weights[i] * in[x + i], for x below padded(width). `in` begins weights.size() / 2 values
/// left of the row.
void convolve(const float* in, std::span<const float> weights, float* out, int width);
void convolve(const double* in, std::span<const double> weights, double* out, int width);
/// out[x] = sum of weights[i] * rows[i][x].
void convolve_down(const float* const* rows, std::span<const float> weights, float* out, int width);
void convolve_down(const double* const* rows, std::span<const double> weights, double* out, int width);

/// Three planes of one row.
struct Planes {
    float* a;
    float* b;
    float* c;
};
struct ConstPlanes {
    const float* a;
    const float* b;
    const float* c;
};

/// Linear Rec. 709 RGB to Y Cx Cz.
void to_ycxcz(ConstPlanes rgb, Planes ycxcz, int width);
/// Y Cx Cz to CIELab, through linear RGB clamped to [0, 1], with Hunt's adjustment of a and b.
void to_hunt_lab(ConstPlanes ycxcz, Planes lab, int width);
/// HyAB distance.
void distance(ConstPlanes reference, ConstPlanes test, float* out, int width);

/// First and second derivatives in x and y.
struct Gradients {
    const float* dx;
    const float* dy;
    const float* ddx;
    const float* ddy;
};
/// The larger difference of edges and of points over sqrt 2, its square root taken (exponent 0.5).
void feature_difference(const Gradients& reference, const Gradients& test, float* out, int width);

/// Scale by 2^stops, map by (x (x a0 + a1) + a2) / (x (x a3 + a4) + a5), clamp to [0, 1]; NaN becomes 0.
void expose_and_map(ConstPlanes rgb, float scale, const float* coefficients, Planes out, int width);
/// Scale, divide by 1 + luminance, clamp to [0, 1]; NaN becomes 0.
void expose_and_divide(ConstPlanes rgb, float scale, Planes out, int width);

}  // namespace aftershade::rows
