// The rows of FLIP, inside of flip.cpp, and the tone mappers of HDR-FLIP.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "framework/compare/row_filter.h"
#include "framework/image/image.h"

namespace aftershade {

enum class ToneMapper { aces, reinhard, hable };
std::string_view tone_mapper_name(ToneMapper mapper);
std::optional<ToneMapper> find_tone_mapper(std::string_view name);
std::vector<std::string> tone_mapper_names();

/// a0 to a5 of (x (x a0 + a1) + a2) / (x (x a3 + a4) + a5): ACES (Narkowicz's fit, its exposure of 0.6 taken
/// out) and Hable. Reinhard divides by luminance and has none.
const std::array<float, 6>& tone_mapper_coefficients(ToneMapper mapper);

/// The transform of linear light before LDR-FLIP.
struct FlipExposure {
    ToneMapper mapper = ToneMapper::aces;
    float scale = 1;
    bool map = false;  ///< false: clamped alone
};

/// The kernels, separated: Y, Cx, and Cz as the sum of two Gaussians; and a Gaussian with its derivatives.
struct FlipFilters {
    explicit FlipFilters(float pixels_per_degree);
    std::vector<float> y, cx, cz1, cz2;        ///< 2 color_radius + 1 taps
    std::vector<float> smooth, first, second;  ///< 2 feature_radius + 1 taps
    int color_radius = 0, feature_radius = 0;
};

/// Filters a band of rows from the top: each row of the picture once across, kept in a ring until the rows
/// below need it no longer, then down. [one thread at a time]
class FlipBand {
public:
    FlipBand(const Image& reference, const Image& test, const FlipFilters& filters);

    /// Raises `error` to the LDR-FLIP of rows first to last - 1 at that exposure.
    void add(int first, int last, const FlipExposure& exposure, Image& error);

private:
    /// The values of a row of one image after the horizontal filters.
    enum Plane { kY, kCx, kCz1, kCz2, kSmooth, kFirst, kSecond, kPlanes };
    using Row = std::vector<float>;

    void load(const Image& image, int y, const FlipExposure& exposure);
    void filter_across(const Image& image, int y, const FlipExposure& exposure, std::size_t which);
    void filter_down(std::size_t which, Plane plane, const std::vector<float>& weights, int radius, int y,
                     float* out);
    void filter_colors(std::size_t which, int y);
    rows::Gradients filter_features(std::size_t which, int y);
    void combine(int y, Image& error);
    float* ring_row(std::size_t which, Plane plane, int y);
    Row row() const { return Row(std::size_t(rows::padded(width_))); }

    const Image& reference_;
    const Image& test_;
    const FlipFilters& filters_;
    int width_ = 0, height_ = 0, radius_ = 0;
    std::vector<float> ring_;
    std::array<Row, 3> stored_, linear_;           // of the row that is filtered across; after exposure
    std::array<Row, 3> opponent_;                  // Y Cx Cz, with the border values repeated outwards
    std::array<Row, 4> filtered_;                  // Y, Cx, and the two parts of Cz
    std::array<std::array<Row, 3>, 2> lab_;        // of both images
    std::array<std::array<Row, 4>, 2> gradients_;  // of both images
    Row color_, feature_;
    std::vector<const float*> taps_;
};

}  // namespace aftershade
