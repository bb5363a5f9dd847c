#include "framework/inspect/channel_statistics.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "framework/core/error.h"

namespace aftershade {

namespace {

template <class Value>
ChannelStatistics statistics_of(std::span<const Value> values, std::size_t channel, std::size_t channels) {
    ChannelStatistics result;
    Value min{}, max{};
    bool any_finite = false;
    for (std::size_t i = channel; i < values.size(); i += channels) {
        const Value value = values[i];
        result.negative += double(value) < 0;
        if (std::isnan(double(value))) {
            ++result.nan;
        } else if (std::isinf(double(value))) {
            ++result.infinite;
        } else {
            min = any_finite ? std::min(min, value) : value;
            max = any_finite ? std::max(max, value) : value;
            any_finite = true;
        }
    }
    if (any_finite) result.min = min, result.max = max;
    return result;
}

/// Why a channel has no figures by its nature; "" where it has.
std::string obstacle(const ExrPart& part, const ExrChannel& channel) {
    if (part.type.starts_with("deep")) return "deep: any number of values a pixel";
    if (channel.x_sampling == 1 && channel.y_sampling == 1) return "";
    return "subsampled " + std::to_string(channel.x_sampling) + " x " + std::to_string(channel.y_sampling);
}

std::string without_path(const std::string& message, const ExrFile& file) {
    const std::string prefix = file.path().string() + ": ";
    return message.starts_with(prefix) ? message.substr(prefix.size()) : message;
}

using Batch = std::vector<InspectedChannel*>;

void read_batch(const ExrFile& file, int part, const Batch& batch) {
    std::vector<std::string> names;
    for (const InspectedChannel* inspected : batch) names.push_back(inspected->channel.name);
    try {
        const bool is_uint = batch.front()->channel.type == PixelType::uint32;
        const Image image = is_uint ? file.read_uints(part, names) : file.read_floats(part, names);
        for (std::size_t i = 0; i < batch.size(); ++i)
            batch[i]->statistics = channel_statistics(image, int(i));
    } catch (const Error& error) {
        for (InspectedChannel* inspected : batch) {
            inspected->reason = without_path(error.what(), file);
            inspected->readable = false;
        }
    }
}

}  // namespace

ChannelStatistics channel_statistics(const Image& image, int channel) {
    const std::size_t first = std::size_t(channel), channels = std::size_t(image.channels());
    if (image.type() == ComponentType::uint32) return statistics_of(image.uints(), first, channels);
    return statistics_of(image.floats(), first, channels);
}

std::vector<InspectedChannel> inspect_channels(const ExrFile& file, int part, const ReadLimits& limits) {
    const ExrPart& header = file.parts()[std::size_t(part)];
    std::vector<InspectedChannel> channels;
    for (const ExrChannel& channel : header.channels)
        channels.push_back({channel, std::nullopt, obstacle(header, channel), true});

    // Every read decompresses the whole part, so as many channels as may be are read together.
    const std::uint64_t bytes =
        std::uint64_t(header.data_window.width()) * std::uint64_t(header.data_window.height()) * 4;
    const std::size_t most =
        std::max<std::uint64_t>(1, limits.max_image_bytes / 2 / std::max<std::uint64_t>(bytes, 1));
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

}  // namespace aftershade
