#include "framework/compare/layer_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <optional>
#include <utility>

#include "framework/base/atomic_file.h"
#include "framework/base/error.h"
#include "framework/base/lfs_pointer.h"
#include "framework/file/hdr_file.h"
#include "framework/file/object_manifest.h"
#include "framework/file/png_file.h"
#include "framework/file/stored_colors.h"

namespace aftershade {

namespace fs = std::filesystem;

struct LayerFile::Impl {
    fs::path path;
    std::string format;
    std::vector<LayerInfo> layers;
    FileTraits traits;
    std::optional<ExrFile> exr;
    Image whole;                           // of formats without parts
    std::vector<std::string> whole_names;  // its channels

    void open_exr(ExrFile file);
    void read_manifests(const ExrMetadata& metadata);
    void open_flat(Image image, LayerRole color, const StoredPrecision& stored);
    void open_png();
    int part_of(const LayerInfo& layer) const;
    Image read_exr(const LayerInfo& layer, const std::vector<std::string>& channels) const;
    Image from_whole(const std::vector<std::string>& channels) const;
};

namespace {

const std::vector<std::string> kColors = {"R", "G", "B"};

/// Both images have one size and type.
void copy_channel(const Image& from, int source, Image& to, int target) {
    const auto copy = [&](const auto values, const auto result) {
        const auto stride = std::size_t(from.channels()), step = std::size_t(to.channels());
        for (std::size_t i = 0; i * step < result.size(); ++i)
            result[i * step + std::size_t(target)] = values[i * stride + std::size_t(source)];
    };
    if (to.type() == ComponentType::uint32) copy(from.uints(), to.uints());
    else copy(from.floats(), to.floats());
}

const ExrChannel* find_channel(const ExrPart& part, const std::string& name) {
    const auto found = std::ranges::find(part.channels, name, &ExrChannel::name);
    return found == part.channels.end() ? nullptr : &*found;
}

bool is_subsampled(const ExrChannel& channel) {
    return channel.x_sampling != 1 || channel.y_sampling != 1;
}

/// Luminance at full and chroma at half resolution, which OpenEXR's own filters make a picture of.
bool is_luminance_chroma(const ExrPart& part) {
    const auto is_half = [&](const char* name) {
        const ExrChannel* const channel = find_channel(part, name);
        return channel && channel->x_sampling == 2 && channel->y_sampling == 2;
    };
    const ExrChannel* const luminance = find_channel(part, "Y");
    return luminance && !is_subsampled(*luminance) && is_half("RY") && is_half("BY") &&
           std::ranges::none_of(kColors, [&](const auto& name) { return find_channel(part, name); });
}

}  // namespace

void LayerFile::Impl::open_exr(ExrFile file) {
    format = "OpenEXR";
    exr = std::move(file);
    const std::vector<ExrPart>& parts = exr->parts();
    traits.first_view = parts.front().view;
    if (const auto views = parts.front().metadata.texts("multiView"); views && traits.first_view.empty())
        traits.first_view = views->empty() ? "" : views->front();
    traits.pixel_aspect = parts.front().pixel_aspect;
    for (std::size_t i = 0; i < parts.size(); ++i) {
        const std::string name = parts.size() > 1 ? parts[i].name : "";
        if (parts[i].has_smaller_levels)
            traits.left_out.push_back("smaller levels of the tiles" +
                                      (name.empty() ? "" : " of part '" + name + "'"));
        read_manifests(parts[i].metadata);
        std::vector<ExrChannel> channels = parts[i].channels;
        // As colours too, so that it can be held against a file of R, G and B. The converter reads first
        // parts.
        if (i == 0 && is_luminance_chroma(parts[i]))
            for (const std::string& color : kColors) channels.push_back({color, PixelType::half});
        for (LayerInfo& layer :
             layers_of_channels(name, channels, parts[i].data_window, parts[i].display_window)) {
            if (!name.empty()) layer.view = parts[i].view;
            layers.push_back(std::move(layer));
        }
    }
    // The first part with colours says what they are; without any, the first part.
    const auto color =
        std::ranges::find_if(layers, [](const LayerInfo& at) { return is_perceptual(at.role); });
    const int hero = color == layers.end() ? 0 : part_of(*color);
    const StoredColors stored = stored_colors(parts.front().metadata, parts[std::size_t(hero)].metadata);
    traits.colors = stored.meaning();
    if (!stored.encoding.is_light()) return;
    // Writers round: primaries of one name are the same.
    const Chromaticities& primaries = stored.encoding.primaries;
    traits.primaries = color_space_primaries(name_of_primaries(primaries)).value_or(primaries);
}

void LayerFile::Impl::read_manifests(const ExrMetadata& metadata) {
    for (const std::string& key : cryptomatte_keys(metadata)) try {
            for (const ManifestEntry& entry : read_object_manifest(path, metadata, key))
                if (entry.id)
                    traits.objects[metadata.text(key + "/name").value_or("")][*entry.id].insert(entry.object);
        } catch (const Error& error) {
            traits.left_out.push_back(std::string("names of objects (") + error.what() + ")");
        }
}

void LayerFile::Impl::open_flat(Image image, LayerRole color, const StoredPrecision& stored) {
    static const std::array<std::vector<std::string>, 4> names = {
        {{"Y"}, {"Y", "A"}, {"R", "G", "B"}, {"R", "G", "B", "A"}}};
    whole = std::move(image);
    whole_names = names[std::size_t(whole.channels() - 1)];
    std::vector<ExrChannel> channels;
    for (const std::string& channel : whole_names) channels.push_back({channel, PixelType::float32});
    const Window window{0, 0, whole.width() - 1, whole.height() - 1};
    layers = layers_of_channels("", channels, window, window);
    for (LayerInfo& layer : layers) {
        layer.stored = stored;
        if (layer.role == LayerRole::color) layer.role = color;
    }
}

void LayerFile::Impl::open_png() {
    format = "PNG";
    PngColor color;
    Image image = read_png(path, &color);
    traits.colors = color.space;
    traits.pixel_aspect = color.pixel_aspect;
    if (color.is_animated) traits.left_out.push_back("all pictures of the animation but the first");
    const bool is_known = color.encoding && !color.is_srgb();
    if (is_known) traits.display = *color.encoding;
    else if (!color.is_srgb())
        traits.notes.push_back("its colours are of " + color.space + ", and are read as sRGB");
    if (color.gamma && !is_known) {
        traits.notes.push_back(fmt::format(
            "its chunk gAMA {:.5g} is applied: colours are compared as sRGB encodes them", *color.gamma));
        const int colors = image.channels() - (image.channels() % 2 == 0 ? 1 : 0);
        for (int y = 0; y < image.height(); ++y)
            for (int x = 0; x < image.width(); ++x)
                for (int c = 0; c < colors; ++c)
                    image.at(x, y, c) = encoded_as_srgb(image.at(x, y, c), *color.gamma);
    }
    StoredPrecision stored;
    stored.step = color.bits == 16 ? 1.0 / 65535 : 1.0 / 255;
    open_flat(std::move(image), LayerRole::display, stored);
}

int LayerFile::Impl::part_of(const LayerInfo& layer) const {
    const std::vector<ExrPart>& parts = exr->parts();
    if (parts.size() == 1) return 0;
    return int(std::ranges::find(parts, layer.part, &ExrPart::name) - parts.begin());
}

Image LayerFile::Impl::from_whole(const std::vector<std::string>& channels) const {
    Image image(whole.width(), whole.height(), int(channels.size()));
    for (std::size_t c = 0; c < channels.size(); ++c) {
        const auto from = std::ranges::find(whole_names, channels[c]);
        assert(from != whole_names.end());
        copy_channel(whole, int(from - whole_names.begin()), image, int(c));
    }
    return image;
}

LayerFile::LayerFile(const fs::path& path, const ReadLimits& limits) : impl_(std::make_unique<Impl>()) {
    impl_->path = path;
    if (file_begins_with(path, "\x89PNG")) {
        impl_->open_png();
    } else if (is_hdr_file(path)) {
        impl_->format = "Radiance HDR";
        // RGBE: eight bits below the exponent that the channels share.
        impl_->open_flat(read_hdr(path), LayerRole::color, {7, -126, 0});
    } else if (is_exr_file(path)) {
        impl_->open_exr(ExrFile(path, limits));
    } else {
        std::error_code error;
        if (!fs::exists(path, error))
            throw Error(ErrorKind::capture, path.string() + ": cannot be opened: No such file or directory");
        if (!fs::is_regular_file(path, error))
            throw Error(ErrorKind::capture, path.string() + ": is not a regular file");
        if (fs::file_size(path, error) == 0)
            throw Error(ErrorKind::capture, path.string() + ": the file is empty");
        if (!std::ifstream(path))
            throw Error(ErrorKind::capture, path.string() + ": cannot be opened: " + std::strerror(errno));
        if (const std::string fault = lfs_fault(path); !fault.empty())
            throw Error(ErrorKind::capture, path.string() + ": " + fault);
        throw Error(ErrorKind::capture,
                    path.string() + ": is neither OpenEXR nor PNG nor Radiance HDR, by its first bytes");
    }
}

LayerFile::LayerFile(OpenFile exr, const ReadLimits& limits) : impl_(std::make_unique<Impl>()) {
    impl_->path = exr.path();
    impl_->open_exr(ExrFile(std::move(exr), limits));
}

LayerFile::~LayerFile() = default;
LayerFile::LayerFile(LayerFile&&) noexcept = default;
LayerFile& LayerFile::operator=(LayerFile&&) noexcept = default;

const fs::path& LayerFile::path() const {
    return impl_->path;
}
const std::string& LayerFile::format() const {
    return impl_->format;
}
const std::vector<LayerInfo>& LayerFile::layers() const {
    return impl_->layers;
}
const FileTraits& LayerFile::traits() const {
    return impl_->traits;
}

/// Subsampled channels are repeated to the size of the others.
Image LayerFile::Impl::read_exr(const LayerInfo& layer, const std::vector<std::string>& channels) const {
    const int at = part_of(layer);
    const ExrPart& part = exr->parts()[std::size_t(at)];
    if (!find_channel(part, channels.front())) {
        const Image colors = exr->read_luminance_chroma(at);
        Image image(colors.width(), colors.height(), int(channels.size()));
        for (std::size_t c = 0; c < channels.size(); ++c)
            copy_channel(colors, int(std::ranges::find(kColors, channels[c]) - kColors.begin()), image,
                         int(c));
        return image;
    }
    const auto repeats = [&](const std::string& name) { return is_subsampled(*find_channel(part, name)); };
    if (std::ranges::none_of(channels, repeats))
        return layer.type == ComponentType::uint32 ? exr->read_uints(at, channels)
                                                   : exr->read_floats(at, channels);
    Image image(part.data_window.width(), part.data_window.height(), int(channels.size()), layer.type);
    for (std::size_t c = 0; c < channels.size(); ++c)
        copy_channel(exr->read_repeated(at, channels[c], layer.type), 0, image, int(c));
    return image;
}

Image LayerFile::read(const LayerInfo& layer, const std::vector<std::string>& channels) const {
    return impl_->exr ? impl_->read_exr(layer, channels) : impl_->from_whole(channels);
}

void LayerFile::prefetch() const {
    if (!impl_->exr) return;
    std::vector<ExrRequest> requests;
    for (const LayerInfo& layer : impl_->layers) {
        const int at = impl_->part_of(layer);
        const ExrPart& part = impl_->exr->parts()[std::size_t(at)];
        const auto is_plain = [&](const std::string& name) {
            const ExrChannel* const channel = find_channel(part, name);
            return channel && !is_subsampled(*channel);
        };
        if (std::ranges::all_of(layer.channels, is_plain))
            requests.push_back({at, layer.channels, layer.type});
    }
    impl_->exr->prefetch(requests);
}

}  // namespace aftershade
