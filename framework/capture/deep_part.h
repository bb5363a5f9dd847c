// A deep part of a file, read as if it were flat, or as one of its layers.
#pragma once

#include <cstdint>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "framework/capture/deep_layers.h"
#include "framework/file/exr_file.h"
#include "framework/image/image.h"

namespace aftershade {

/// The handling of a pixel's samples.
struct DeepRead {
    int layer = -1;      ///< one of them; -1: all, as a flat picture
    bool blends = true;  ///< put over one another; else the value of the sample that shows most
};

/// [one thread at a time]
class DeepPart {
public:
    /// `layers`, at least 1, to which the samples are reduced. `file` must outlive this.
    DeepPart(const ExrFile& file, int part, int layers);

    int layers() const { return layers_; }
    int width() const;
    /// Channels that are read next, to unpack them together.
    void expect(std::span<const std::string> channels);
    /// Interleaved in the order given, over the part's data window; `outside` where no sample is, 0 where
    /// they blend. Depth that does not blend is the middle of Z and ZBack. Throws Error(ErrorKind::capture),
    /// also where the part has no depth Z.
    Image read_floats(std::span<const std::string> channels, const DeepRead& how, float outside);
    /// One channel of unsigned integers; 0 where no sample is.
    Image read_uints(const std::string& channel, const DeepRead& how);
    /// The covered share of each pixel.
    Image read_alpha(const DeepRead& how);
    const DeepReduction& reduction();
    /// How many pixels have 0, 1, 2, ... samples; what has `most` or more is counted together.
    std::vector<std::uint64_t> histogram(int most);

private:
    std::string channel_called(const std::string& name) const;
    void load(std::span<const std::string> channels);
    const DeepLayers& reduced();

    const ExrFile& file_;
    int part_;
    int layers_;
    std::string front_, back_, alpha_;  // channels; back and alpha may be ""
    std::set<std::string> expected_;
    DeepImage image_;
    std::vector<std::uint32_t> first_;  // outlives what is loaded
    std::optional<DeepLayers> reduced_;
};

}  // namespace aftershade
