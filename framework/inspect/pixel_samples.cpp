#include "framework/inspect/pixel_samples.h"

#include <algorithm>
#include <bit>

namespace aftershade {

std::vector<SampleCount> sample_histogram(const ExrFile& file, int part) {
    const DeepImage image = file.read_deep(part, {});
    std::vector<SampleCount> counts = {{0, 0, 0}, {1, 1, 0}};
    for (std::size_t i = 0; i < image.pixel_count(); ++i) {
        const std::uint64_t samples = image.first[i + 1] - image.first[i];
        const std::size_t at =
            samples < 2 ? std::size_t(samples) : std::size_t(std::bit_width(samples - 1)) + 1;
        while (counts.size() <= at) counts.push_back({counts.back().most + 1, counts.back().most * 2, 0});
        ++counts[at].pixels;
    }
    return counts;
}

PixelSamples samples_at(const ExrFile& file, int part, int x, int y) {
    const ExrPart& info = file.parts()[std::size_t(part)];
    PixelSamples result;
    if (!info.data_window.contains(x, y)) return result;
    for (const ExrChannel& channel : info.channels)
        if (channel.x_sampling == 1 && channel.y_sampling == 1) result.channels.push_back(channel.name);
    const int column = x - info.data_window.min_x, row = y - info.data_window.min_y;
    if (info.is_deep()) {
        const DeepImage image = file.read_deep(part, result.channels);
        const std::size_t pixel = std::size_t(row) * std::size_t(image.width) + std::size_t(column);
        for (std::uint32_t i = image.first[pixel]; i < image.first[pixel + 1]; ++i) {
            std::vector<double>& sample = result.samples.emplace_back();
            for (const DeepImage::Channel& channel : image.channels)
                sample.push_back(channel.uints.empty() ? double(channel.floats[i])
                                                       : double(channel.uints[i]));
        }
        return result;
    }
    std::vector<double>& sample = result.samples.emplace_back();
    for (const std::string& name : result.channels) {
        const auto stored = std::ranges::find(info.channels, name, &ExrChannel::name);
        const std::vector<std::string> one = {name};
        if (stored->type == PixelType::uint32)
            sample.push_back(double(file.read_uints(part, one).uint_at(column, row, 0)));
        else sample.push_back(double(file.read_floats(part, one).at(column, row, 0)));
    }
    return result;
}

}  // namespace aftershade
