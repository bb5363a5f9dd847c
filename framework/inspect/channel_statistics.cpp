#include "framework/inspect/channel_statistics.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <span>
#include <type_traits>

#include "framework/base/error.h"

namespace aftershade {

namespace {

/// One channel's figures while pixels pass by.
template <class Value>
struct Running {
    ChannelStatistics figures;
    Value min = std::numeric_limits<Value>::max();
    Value max = std::numeric_limits<Value>::lowest();

    void add(Value value) {
        if constexpr (std::is_floating_point_v<Value>) {
            if (!std::isfinite(value)) {
                if (std::isnan(value)) ++figures.nan;
                else ++figures.infinite;
                figures.negative += value < 0;
                return;
            }
        }
        figures.negative += value < 0;
        min = std::min(min, value);
        max = std::max(max, value);
    }
    ChannelStatistics finished() const {
        ChannelStatistics result = figures;
        if (min <= max) result.min = min, result.max = max;
        return result;
    }
};

/// In one pass: an image of many channels is larger than any cache.
template <class Value>
std::vector<ChannelStatistics> statistics_of(std::span<const Value> values, std::size_t channels) {
    std::vector<Running<Value>> running(channels);
    for (std::size_t i = 0; i + channels <= values.size(); i += channels)
        for (std::size_t c = 0; c < channels; ++c) running[c].add(values[i + c]);
    std::vector<ChannelStatistics> result;
    for (const Running<Value>& one : running) result.push_back(one.finished());
    return result;
}

/// Why a channel has no figures by its nature; "" where it has.
std::string obstacle(const ExrChannel& channel) {
    if (channel.x_sampling == 1 && channel.y_sampling == 1) return "";
    return "subsampled " + std::to_string(channel.x_sampling) + " x " + std::to_string(channel.y_sampling);
}

std::string without_path(const std::string& message, const ExrFile& file) {
    const std::string prefix = file.path().string() + ": ";
    return message.starts_with(prefix) ? message.substr(prefix.size()) : message;
}

using Batch = std::vector<InspectedChannel*>;

/// Of every sample.
std::vector<ChannelStatistics> deep_statistics(const ExrFile& file, int part,
                                               const std::vector<std::string>& names) {
    const DeepImage image = file.read_deep(part, names);
    std::vector<ChannelStatistics> result;
    for (const std::string& name : names) {
        const DeepImage::Channel& channel = *image.find(name);
        const auto of_one = channel.uints.empty() ? statistics_of<float>(channel.floats, 1)
                                                  : statistics_of<std::uint32_t>(channel.uints, 1);
        result.push_back(of_one.front());
    }
    return result;
}

std::vector<ChannelStatistics> flat_statistics(const ExrFile& file, int part,
                                               const std::vector<std::string>& names, bool is_uint) {
    return channel_statistics(is_uint ? file.read_uints(part, names) : file.read_floats(part, names));
}

void read_batch(const ExrFile& file, int part, const Batch& batch) {
    std::vector<std::string> names;
    for (const InspectedChannel* inspected : batch) names.push_back(inspected->channel.name);
    try {
        const bool is_uint = batch.front()->channel.type == PixelType::uint32;
        const std::vector<ChannelStatistics> statistics = file.parts()[std::size_t(part)].is_deep()
                                                              ? deep_statistics(file, part, names)
                                                              : flat_statistics(file, part, names, is_uint);
        for (std::size_t i = 0; i < batch.size(); ++i) batch[i]->statistics = statistics[i];
    } catch (const Error& error) {
        for (InspectedChannel* inspected : batch) {
            inspected->reason = without_path(error.what(), file);
            inspected->readable = false;
        }
    }
}

}  // namespace

std::vector<ChannelStatistics> channel_statistics(const Image& image) {
    const std::size_t channels = std::size_t(image.channels());
    if (image.type() == ComponentType::uint32) return statistics_of(image.uints(), channels);
    return statistics_of(image.floats(), channels);
}

std::vector<InspectedChannel> inspect_channels(const ExrFile& file, int part, const ReadLimits& limits) {
    const ExrPart& header = file.parts()[std::size_t(part)];
    std::vector<InspectedChannel> channels;
    for (const ExrChannel& channel : header.channels)
        channels.push_back({channel, std::nullopt, obstacle(channel), true});

    // Every read decompresses the whole part, so as many channels as may be are read together.
    const std::uint64_t bytes =
        std::uint64_t(header.data_window.width()) * std::uint64_t(header.data_window.height()) * 4;
    const std::size_t most =
        std::max<std::uint64_t>(1, limits.max_image_bytes / 4 * 3 / std::max<std::uint64_t>(bytes, 1));
    for (const bool uints : {false, true}) {
        Batch batch;
        for (InspectedChannel& inspected : channels) {
            if (!inspected.reason.empty() || (inspected.channel.type == PixelType::uint32) != uints) continue;
            batch.push_back(&inspected);
            if (batch.size() < most) continue;
            read_batch(file, part, batch);
            batch.clear();
        }
        if (!batch.empty()) read_batch(file, part, batch);
    }
    return channels;
}

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
