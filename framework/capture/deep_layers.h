// Deep pixels as a few layers, front to back.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "framework/image/image.h"

namespace aftershade {

inline constexpr int kDefaultDeepLayers = 4;
inline constexpr int kMostLayers = 8;

/// The values that decide the place of a sample and the samples that it hides. By sample.
struct DeepGeometry {
    std::span<const std::uint32_t> first;  ///< by pixel, and one more: where its samples begin
    std::span<const float> front;          ///< Z, in any unit
    std::span<const float> back;           ///< ZBack; empty: samples have no extent
    std::span<const float> alpha;          ///< empty: opaque
};

/// The reduction of the samples, over the pixels that have any.
struct DeepReduction {
    std::uint64_t samples = 0;
    std::uint64_t most_samples = 0;   ///< in a pixel
    std::uint64_t pixels = 0;         ///< with samples
    std::uint64_t nan_pixels = 0;     ///< where a sample has no depth, and counts as behind all others
    std::size_t first_nan = 0;        ///< by rows
    std::uint64_t merged_pixels = 0;  ///< that have more gaps than layers can show
    /// Mean of |ln(depth of the sample / depth of its layer)|, weighted by each sample's visible share, and
    /// the largest mean of one pixel. 0.01 means that the visible surface moved by 1 % in depth.
    double mean_shift = 0;
    double most_shift = 0;

    /// "4911 deep samples, 1.9 in a pixel that has any and 12 at most, are reduced to 4 layers: 3 % of ..."
    std::string text(int layers) const;
};

/// The layer of each sample and its share in it.
///
/// Samples are sorted by depth, and those with an extent count as homogeneous volumes. Samples that overlap
/// or lie at one depth are mixed as Kainz, "Interpreting OpenEXR Deep Pixels" (2013), says. A pixel is split
/// where nothing lies between a depth and one more than 1 % further away. Where that gives more layers than
/// there may be, neighbours are put together, each time those whose union moves the least light, in 1 /
/// depth; of equals the furthest. Hidden samples are a layer, too: they move no light, so that the nearest of
/// them stays by itself.
class DeepLayers {
public:
    static constexpr std::uint32_t kNoSample = 0xffffffff;

    /// `first` must outlive this. Throws std::bad_alloc.
    DeepLayers(const DeepGeometry& geometry, int layers);

    int count() const { return layers_; }
    const DeepReduction& reduction() const { return reduction_; }
    /// In a layer, or with -1 in the whole pixel: the sum of the samples' values by their shares. For what is
    /// stored multiplied by alpha, and alpha itself. 0 where there is no sample.
    float blended(std::span<const float> values, std::size_t pixel, int layer) const;
    /// The alpha of a layer, or with -1 of the whole pixel.
    float alpha(std::size_t pixel, int layer) const;
    /// The sample that shows most of a layer; with -1 of the layer that shows most, the nearest of equals.
    std::uint32_t shown(std::size_t pixel, int layer) const;

private:
    friend class DeepPixel;
    std::size_t at(std::size_t pixel, int layer) const {
        return pixel * std::size_t(layers_) + std::size_t(layer);
    }

    int layers_;
    std::span<const std::uint32_t> first_;
    std::vector<std::uint8_t> layer_;   // by sample
    std::vector<float> share_;          // by sample, in its layer
    std::vector<float> alpha_;          // by pixel and layer
    std::vector<std::uint32_t> shown_;  // by pixel and layer
    DeepReduction reduction_;
};

}  // namespace aftershade
