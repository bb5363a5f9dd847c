// The samples of deep pixels in memory.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace aftershade {

/// Any number of samples in each pixel, rows from the top. [value type: safe to read from several threads]
struct DeepImage {
    /// A value for each sample: `floats`, or `uints` where the file stores unsigned integers.
    struct Channel {
        std::string name;
        std::vector<float> floats{};
        std::vector<std::uint32_t> uints{};
    };

    int width = 0;
    int height = 0;
    /// By pixel, and one more at the end: where its samples begin.
    std::vector<std::uint32_t> first;
    std::vector<Channel> channels;

    std::size_t pixel_count() const { return std::size_t(width) * std::size_t(height); }
    std::size_t sample_count() const { return first.empty() ? 0 : first.back(); }
    /// nullptr where there is none of that name.
    const Channel* find(const std::string& name) const {
        for (const Channel& channel : channels)
            if (channel.name == name) return &channel;
        return nullptr;
    }
};

}  // namespace aftershade
