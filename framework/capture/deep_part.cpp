#include "framework/capture/deep_part.h"

#include <algorithm>
#include <utility>

#include "framework/base/error.h"
#include "framework/capture/channel_names.h"

namespace aftershade {

DeepPart::DeepPart(const ExrFile& file, int part, int layers) : file_(file), part_(part), layers_(layers) {
    front_ = channel_called("Z");
    back_ = channel_called("ZBack");
    alpha_ = channel_called("A");
}

/// By its full name, else in a layer, else in another spelling.
std::string DeepPart::channel_called(const std::string& name) const {
    const std::string canonical = canonical_name(name);
    const auto fits = [&](const std::string& channel, int spelling) {
        const std::string own = canonical_name(channel);
        switch (spelling) {
            case 0: return channel == name;
            case 1: return channel.ends_with("." + name);
            case 2: return own == canonical;
            default: return own.ends_with("." + canonical);
        }
    };
    for (const int spelling : {0, 1, 2, 3})
        for (const ExrChannel& channel : file_.parts()[std::size_t(part_)].channels)
            if (channel.type != PixelType::uint32 && fits(channel.name, spelling)) return channel.name;
    return "";
}

int DeepPart::width() const {
    return file_.parts()[std::size_t(part_)].data_window.width();
}

void DeepPart::expect(std::span<const std::string> channels) {
    expected_.insert(channels.begin(), channels.end());
}

/// What is not there yet, together with what is expected; the image then holds nothing else.
void DeepPart::load(std::span<const std::string> channels) {
    const auto is_there = [&](const std::string& name) { return image_.find(name) != nullptr; };
    if (std::all_of(channels.begin(), channels.end(), is_there)) return;
    std::set<std::string> names = std::exchange(expected_, {});
    names.insert(channels.begin(), channels.end());
    image_ = file_.read_deep(part_, std::vector<std::string>(names.begin(), names.end()));
    if (first_.empty()) first_ = image_.first;
    if (first_ != image_.first)
        throw Error(ErrorKind::capture, file_.path().string() +
                                            ": was changed while it was read (render to another "
                                            "name and rename the file)");
}

const DeepLayers& DeepPart::reduced() {
    if (reduced_) return *reduced_;
    if (front_.empty())
        throw Error(
            ErrorKind::capture,
            file_.path().string() + ": its deep part" +
                (file_.parts().size() > 1 ? " '" + file_.parts()[std::size_t(part_)].name + "'" : "") +
                " has no channel Z, by which samples are put in order (" + exr_flatten_remedy(file_.path()) +
                ")");
    std::vector<std::string> names = {front_};
    for (const std::string& name : {back_, alpha_})
        if (!name.empty()) names.push_back(name);
    load(names);
    const auto span_of = [&](const std::string& name) {
        const DeepImage::Channel* channel = name.empty() ? nullptr : image_.find(name);
        return channel ? std::span<const float>(channel->floats) : std::span<const float>();
    };
    reduced_.emplace(DeepGeometry{first_, span_of(front_), span_of(back_), span_of(alpha_)}, layers_);
    return *reduced_;
}

Image DeepPart::read_floats(std::span<const std::string> channels, const DeepRead& how, float outside) {
    std::vector<std::string> names(channels.begin(), channels.end());
    const bool has_extent = !how.blends && !back_.empty() && std::ranges::find(names, front_) != names.end();
    if (has_extent) names.push_back(back_);
    expect(names);
    const DeepLayers& layers = reduced();
    load(names);
    Image image(image_.width, image_.height, int(channels.size()));
    const std::span<float> out = image.floats();
    for (std::size_t c = 0; c < channels.size(); ++c) {
        const DeepImage::Channel& channel = *image_.find(channels[c]);
        const std::vector<float> widened(channel.uints.begin(), channel.uints.end());
        const std::span<const float> values =
            channel.uints.empty() ? std::span<const float>(channel.floats) : widened;
        const DeepImage::Channel* back = has_extent && channels[c] == front_ ? image_.find(back_) : nullptr;
        for (std::size_t pixel = 0; pixel < image_.pixel_count(); ++pixel) {
            float& value = out[pixel * channels.size() + c];
            if (how.blends) {
                value = layers.blended(values, pixel, how.layer);
                continue;
            }
            const std::uint32_t sample = layers.shown(pixel, how.layer);
            if (sample == DeepLayers::kNoSample) value = outside;
            else
                value = back && back->floats[sample] > values[sample]
                            ? values[sample] / 2 + back->floats[sample] / 2
                            : values[sample];
        }
    }
    return image;
}

Image DeepPart::read_uints(const std::string& channel, const DeepRead& how) {
    expect(std::span(&channel, 1));
    const DeepLayers& layers = reduced();
    load(std::span(&channel, 1));
    const std::vector<std::uint32_t>& stored = image_.find(channel)->uints;
    Image image(image_.width, image_.height, 1, ComponentType::uint32);
    for (std::size_t pixel = 0; pixel < image_.pixel_count(); ++pixel) {
        const std::uint32_t sample = layers.shown(pixel, how.layer);
        if (sample != DeepLayers::kNoSample) image.uints()[pixel] = stored[sample];
    }
    return image;
}

Image DeepPart::read_alpha(const DeepRead& how) {
    const DeepLayers& layers = reduced();
    Image image(image_.width, image_.height, 1);
    for (std::size_t pixel = 0; pixel < image_.pixel_count(); ++pixel)
        image.floats()[pixel] = layers.alpha(pixel, how.layer);
    return image;
}

const DeepReduction& DeepPart::reduction() {
    return reduced().reduction();
}

std::vector<std::uint64_t> DeepPart::histogram(int most) {
    (void)reduced();
    std::vector<std::uint64_t> counts(std::size_t(most) + 1);
    for (std::size_t pixel = 0; pixel < image_.pixel_count(); ++pixel)
        ++counts[std::min<std::size_t>(first_[pixel + 1] - first_[pixel], std::size_t(most))];
    return counts;
}

}  // namespace aftershade
