#include "framework/compare/row_filter.h"

#include "framework/image/luminance.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

namespace aftershade::rows {

namespace {

#define AFTERSHADE_INLINE inline __attribute__((always_inline))

AFTERSHADE_INLINE float clamp01(float value) {
    value = value > 0 ? value : 0;  // false for NaN
    return value < 1 ? value : 1;
}

/// Halley's iteration from the exponent divided by three: relative error below 2e-7 for normal numbers.
AFTERSHADE_INLINE float cube_root(float a) {
    constexpr std::uint32_t kThirdOfBias = 709921077;
    const auto third = std::int32_t(float(std::bit_cast<std::int32_t>(a)) * (1.0f / 3.0f));
    float x = std::bit_cast<float>(third + std::int32_t(kThirdOfBias));
    for (int i = 0; i < 2; ++i) {
        const float cube = x * x * x;
        x = x * (cube + 2 * a) / (2 * cube + a);
    }
    return x;
}

struct Triple {
    float a, b, c;
};

// The matrices, white point and scales of NVIDIA's implementation.
AFTERSHADE_INLINE Triple xyz_of_rgb(Triple rgb) {
    return {
        10135552.0f / 24577794.0f * rgb.a + 8788810.0f / 24577794.0f * rgb.b +
            4435075.0f / 24577794.0f * rgb.c,
        2613072.0f / 12288897.0f * rgb.a + 8788810.0f / 12288897.0f * rgb.b + 887015.0f / 12288897.0f * rgb.c,
        1425312.0f / 73733382.0f * rgb.a + 8788810.0f / 73733382.0f * rgb.b +
            70074185.0f / 73733382.0f * rgb.c};
}

AFTERSHADE_INLINE Triple rgb_of_xyz(Triple xyz) {
    return {3.241003275f * xyz.a - 1.537398934f * xyz.b - 0.498615861f * xyz.c,
            -0.969224334f * xyz.a + 1.875930071f * xyz.b + 0.041554224f * xyz.c,
            0.055639423f * xyz.a - 0.204011202f * xyz.b + 1.057148933f * xyz.c};
}

constexpr float kWhiteX = 0.950428545f, kWhiteZ = 1.088900371f;
constexpr float kOverWhiteX = 1.052156925f, kOverWhiteZ = 0.918357670f;

AFTERSHADE_INLINE float lab_curve(float t) {
    constexpr float kDelta = 6.0f / 29.0f;
    const float root = cube_root(t > 1e-3f ? t : 1e-3f);
    const float line = t / (3.0f * kDelta * kDelta) + 4.0f / 29.0f;
    return t > kDelta * kDelta * kDelta ? root : line;
}

AFTERSHADE_INLINE Triple lab_of_xyz(Triple xyz) {
    const float x = lab_curve(xyz.a * kOverWhiteX), y = lab_curve(xyz.b), z = lab_curve(xyz.c * kOverWhiteZ);
    return {116.0f * y - 16.0f, 500.0f * (x - y), 200.0f * (y - z)};
}

template <class Number>
AFTERSHADE_INLINE void convolve_body(const Number* in, const Number* weights, int taps, Number* out,
                                     int width) {
    for (int x = 0; x < width; x += kLanes) {
        Number sum[kLanes] = {};
        for (int i = 0; i < taps; ++i)
            for (int lane = 0; lane < kLanes; ++lane) sum[lane] += weights[i] * in[x + i + lane];
        for (int lane = 0; lane < kLanes; ++lane) out[x + lane] = sum[lane];
    }
}

template <class Number>
AFTERSHADE_INLINE void convolve_down_body(const Number* const* in, const Number* weights, int taps,
                                          Number* out, int width) {
    for (int x = 0; x < width; x += kLanes) {
        Number sum[kLanes] = {};
        for (int i = 0; i < taps; ++i)
            for (int lane = 0; lane < kLanes; ++lane) sum[lane] += weights[i] * in[i][x + lane];
        for (int lane = 0; lane < kLanes; ++lane) out[x + lane] = sum[lane];
    }
}

AFTERSHADE_INLINE void to_ycxcz_body(const float* __restrict r, const float* __restrict g,
                                     const float* __restrict b, float* __restrict y, float* __restrict cx,
                                     float* __restrict cz, int width) {
    for (int i = 0; i < width; ++i) {
        const Triple xyz = xyz_of_rgb({r[i], g[i], b[i]});
        const float x = xyz.a * kOverWhiteX, z = xyz.c * kOverWhiteZ;
        y[i] = 116.0f * xyz.b - 16.0f;
        cx[i] = 500.0f * (x - xyz.b);
        cz[i] = 200.0f * (xyz.b - z);
    }
}

AFTERSHADE_INLINE void to_hunt_lab_body(const float* __restrict y, const float* __restrict cx,
                                        const float* __restrict cz, float* __restrict l, float* __restrict a,
                                        float* __restrict b, int width) {
    for (int i = 0; i < width; ++i) {
        const float relative_y = (y[i] + 16.0f) / 116.0f;
        const Triple rgb = rgb_of_xyz(
            {(relative_y + cx[i] / 500.0f) * kWhiteX, relative_y, (relative_y - cz[i] / 200.0f) * kWhiteZ});
        const Triple lab = lab_of_xyz(xyz_of_rgb({clamp01(rgb.a), clamp01(rgb.b), clamp01(rgb.c)}));
        l[i] = lab.a;
        a[i] = 0.01f * lab.a * lab.b;
        b[i] = 0.01f * lab.a * lab.c;
    }
}

AFTERSHADE_INLINE void distance_body(const float* __restrict l0, const float* __restrict a0,
                                     const float* __restrict b0, const float* __restrict l1,
                                     const float* __restrict a1, const float* __restrict b1,
                                     float* __restrict out, int width) {
    for (int i = 0; i < width; ++i) {
        const float da = a0[i] - a1[i], db = b0[i] - b1[i];
        out[i] = std::fabs(l0[i] - l1[i]) + std::sqrt(da * da + db * db);
    }
}

AFTERSHADE_INLINE float length(float x, float y) {
    return std::sqrt(x * x + y * y);
}

AFTERSHADE_INLINE void feature_body(const Gradients& r, const Gradients& t, float* __restrict out,
                                    int width) {
    constexpr float kOverSqrt2 = 0.70710678118654752f;
    for (int i = 0; i < width; ++i) {
        const float edge = std::fabs(length(r.dx[i], r.dy[i]) - length(t.dx[i], t.dy[i]));
        const float point = std::fabs(length(r.ddx[i], r.ddy[i]) - length(t.ddx[i], t.ddy[i]));
        out[i] = std::sqrt(kOverSqrt2 * (edge > point ? edge : point));
    }
}

AFTERSHADE_INLINE void map_body(const float* __restrict in, float scale, const float* k,
                                float* __restrict out, int width) {
    for (int i = 0; i < width; ++i) {
        const float v = in[i] * scale;
        out[i] = clamp01((v * v * k[0] + v * k[1] + k[2]) / (v * v * k[3] + v * k[4] + k[5]));
    }
}

constexpr float kShareOfRed = float(kRec709Luminance[0]), kShareOfGreen = float(kRec709Luminance[1]),
                kShareOfBlue = float(kRec709Luminance[2]);

AFTERSHADE_INLINE void divide_body(const ConstPlanes& in, float scale, const Planes& out, int width) {
    for (int i = 0; i < width; ++i) {
        const float r = in.a[i] * scale, g = in.b[i] * scale, b = in.c[i] * scale;
        const float luminance = kShareOfRed * r + kShareOfGreen * g + kShareOfBlue * b;
        const float factor = 1.0f / (1.0f + luminance);
        out.a[i] = clamp01(r * factor);
        out.b[i] = clamp01(g * factor);
        out.c[i] = clamp01(b * factor);
    }
}

}  // namespace

// Each loop once for any machine of the architecture, and once for AVX2, whose registers are twice as wide;
// the loader chooses. Sanitizers of addresses and threads do not bear choices at load time.
#if defined(__x86_64__) && defined(__gnu_linux__) && !defined(__SANITIZE_ADDRESS__) && \
    !defined(__SANITIZE_THREAD__)
#define AFTERSHADE_WIDE __attribute__((target_clones("avx2", "default")))
#else
#define AFTERSHADE_WIDE
#endif

AFTERSHADE_WIDE void convolve(const float* in, std::span<const float> weights, float* out, int width) {
    convolve_body(in, weights.data(), int(weights.size()), out, width);
}

AFTERSHADE_WIDE void convolve_down(const float* const* in, std::span<const float> weights, float* out,
                                   int width) {
    convolve_down_body(in, weights.data(), int(weights.size()), out, width);
}

AFTERSHADE_WIDE void convolve(const double* in, std::span<const double> weights, double* out, int width) {
    convolve_body(in, weights.data(), int(weights.size()), out, width);
}

AFTERSHADE_WIDE void convolve_down(const double* const* in, std::span<const double> weights, double* out,
                                   int width) {
    convolve_down_body(in, weights.data(), int(weights.size()), out, width);
}

AFTERSHADE_WIDE void to_ycxcz(ConstPlanes rgb, Planes out, int width) {
    to_ycxcz_body(rgb.a, rgb.b, rgb.c, out.a, out.b, out.c, width);
}

AFTERSHADE_WIDE void to_hunt_lab(ConstPlanes in, Planes out, int width) {
    to_hunt_lab_body(in.a, in.b, in.c, out.a, out.b, out.c, width);
}

AFTERSHADE_WIDE void distance(ConstPlanes reference, ConstPlanes test, float* out, int width) {
    distance_body(reference.a, reference.b, reference.c, test.a, test.b, test.c, out, width);
}

AFTERSHADE_WIDE void feature_difference(const Gradients& reference, const Gradients& test, float* out,
                                        int width) {
    feature_body(reference, test, out, width);
}

AFTERSHADE_WIDE void expose_and_map(ConstPlanes rgb, float scale, const float* coefficients, Planes out,
                                    int width) {
    map_body(rgb.a, scale, coefficients, out.a, width);
    map_body(rgb.b, scale, coefficients, out.b, width);
    map_body(rgb.c, scale, coefficients, out.c, width);
}

AFTERSHADE_WIDE void expose_and_divide(ConstPlanes rgb, float scale, Planes out, int width) {
    divide_body(rgb, scale, out, width);
}

}  // namespace aftershade::rows
