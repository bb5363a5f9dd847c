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

#include "framework/core/atomic_file.h"
#include "framework/core/error.h"
#include "framework/file/hdr_file.h"
#include "framework/file/png_file.h"

namespace aftershade {

namespace fs = std::filesystem;

struct LayerFile::Impl {
    fs::path path;
    std::string format;
    std::vector<LayerInfo> layers;
    std::optional<ExrFile> exr;
    Image whole;                           // of formats without parts
    std::vector<std::string> whole_names;  // its channels

    void open_exr(ExrFile file);
    void open_flat(Image image, LayerRole color);
    int part_of(const LayerInfo& layer) const;
    Image from_whole(const std::vector<std::string>& channels) const;
};

namespace {

bool is_subsampled(const ExrPart& part) {
    return std::ranges::any_of(part.channels,
                               [](const ExrChannel& c) { return c.x_sampling != 1 || c.y_sampling != 1; });
}

}  // namespace

void LayerFile::Impl::open_exr(ExrFile file) {
    format = "OpenEXR";
    exr = std::move(file);
    const std::vector<ExrPart>& parts = exr->parts();
    for (std::size_t i = 0; i < parts.size(); ++i) {
        const std::string name = parts.size() > 1 ? parts[i].name : "";
        std::vector<ExrChannel> channels = parts[i].channels;
        if (is_subsampled(parts[i])) {
            // Luminance at full and chroma at half resolution: a picture, converted by OpenEXR's own filters.
            whole = exr->read_luminance_chroma(int(i));
            whole_names = {"R", "G", "B", "A"};
            channels.clear();
            for (const std::string& channel : whole_names) channels.push_back({channel, PixelType::half});
        }
        for (LayerInfo& layer :
             layers_of_channels(name, channels, parts[i].data_window, parts[i].display_window))
            layers.push_back(std::move(layer));
    }
}

void LayerFile::Impl::open_flat(Image image, LayerRole color) {
    static const std::array<std::vector<std::string>, 4> names = {
        {{"Y"}, {"Y", "A"}, {"R", "G", "B"}, {"R", "G", "B", "A"}}};
    whole = std::move(image);
    whole_names = names[std::size_t(whole.channels() - 1)];
    std::vector<ExrChannel> channels;
    for (const std::string& channel : whole_names) channels.push_back({channel, PixelType::float32});
    const Window window{0, 0, whole.width() - 1, whole.height() - 1};
    layers = layers_of_channels("", channels, window, window);
    for (LayerInfo& layer : layers)
        if (layer.role == LayerRole::color) layer.role = color;
}

int LayerFile::Impl::part_of(const LayerInfo& layer) const {
    const std::vector<ExrPart>& parts = exr->parts();
    if (parts.size() == 1) return 0;
    return int(std::ranges::find(parts, layer.part, &ExrPart::name) - parts.begin());
}

Image LayerFile::Impl::from_whole(const std::vector<std::string>& channels) const {
    Image image(whole.width(), whole.height(), int(channels.size()));
    const auto pixels = std::size_t(whole.width()) * std::size_t(whole.height());
    for (std::size_t c = 0; c < channels.size(); ++c) {
        const auto from = std::size_t(std::ranges::find(whole_names, channels[c]) - whole_names.begin());
        assert(from < whole_names.size());
        for (std::size_t i = 0; i < pixels; ++i)
            image.floats()[i * channels.size() + c] = whole.floats()[i * whole_names.size() + from];
    }
    return image;
}

LayerFile::LayerFile(const fs::path& path, const ReadLimits& limits) : impl_(std::make_unique<Impl>()) {
    impl_->path = path;
    if (file_begins_with(path, "\x89PNG")) {
        impl_->format = "PNG";
        impl_->open_flat(read_png(path), LayerRole::display);
    } else if (is_hdr_file(path)) {
        impl_->format = "Radiance HDR";
        impl_->open_flat(read_hdr(path), LayerRole::color);
    } else if (is_exr_file(path)) {
        impl_->open_exr(ExrFile(path, limits));
    } else {
        std::error_code error;
        if (!fs::exists(path, error))
            throw Error(ExitCode::capture, path.string() + ": cannot be opened: No such file or directory");
        if (!fs::is_regular_file(path, error))
            throw Error(ExitCode::capture, path.string() + ": is not a regular file");
        if (fs::file_size(path, error) == 0)
            throw Error(ExitCode::capture, path.string() + ": the file is empty");
        if (!std::ifstream(path))
            throw Error(ExitCode::capture, path.string() + ": cannot be opened: " + std::strerror(errno));
        throw Error(ExitCode::capture,
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

Image LayerFile::read(const LayerInfo& layer, const std::vector<std::string>& channels) const {
    if (!impl_->exr) return impl_->from_whole(channels);
    const int part = impl_->part_of(layer);
    if (is_subsampled(impl_->exr->parts()[std::size_t(part)])) return impl_->from_whole(channels);
    return layer.type == ComponentType::uint32 ? impl_->exr->read_uints(part, channels)
                                               : impl_->exr->read_floats(part, channels);
}

void LayerFile::prefetch() const {
    if (!impl_->exr) return;
    std::vector<ExrRequest> requests;
    for (const LayerInfo& layer : impl_->layers)
        requests.push_back({impl_->part_of(layer), layer.channels, layer.type});
    impl_->exr->prefetch(requests);
}

}  // namespace aftershade
