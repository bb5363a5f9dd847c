#include "framework/file/exr_internal.h"

#include <Imath/ImathBox.h>
#include <OpenEXR/Iex.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfInputPart.h>
#include <OpenEXR/ImfMultiPartInputFile.h>
#include <OpenEXR/ImfPartType.h>
#include <OpenEXR/ImfRgbaFile.h>
#include <OpenEXR/ImfThreading.h>
#include <OpenEXR/ImfTiledInputPart.h>
#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cstring>
#include <iterator>
#include <mutex>
#include <set>
#include <utility>

namespace aftershade {

namespace fs = std::filesystem;

namespace {

constexpr std::size_t kChannelsListed = 12;
// Decoding keeps two blocks a thread, each with as much scratch; above this size one at a time is enough.
constexpr std::uint64_t kThreadedBlockBytes = 32 * 1024 * 1024;

/// A second line of defence, for the whole process; the limits of each file are checked by read_layout.
void bound_library() {
    static std::once_flag once;
    std::call_once(once, [] {
        constexpr int kLibrarySide = 65536;
        Imf::Header::setMaxImageSize(kLibrarySide, kLibrarySide);
        Imf::Header::setMaxTileSize(kLibrarySide, kLibrarySide);
    });
}

std::string list_channels(const ExrPart& part) {
    std::string list;
    const std::size_t shown = std::min(part.channels.size(), kChannelsListed);
    for (std::size_t i = 0; i < shown; ++i) list += (i == 0 ? "" : ", ") + part.channels[i].name;
    if (part.channels.size() > shown) list += fmt::format(" and {} more", part.channels.size() - shown);
    return list;
}

char* bytes_of(Image& image) {
    return image.type() == ComponentType::float32 ? reinterpret_cast<char*>(image.floats().data())
                                                  : reinterpret_cast<char*>(image.uints().data());
}

constexpr const char* kChanged = "was changed while it was read (render to another name and rename the file)";

/// The limits were held against the first header, and memory is made by the second.
void require_same_pixels(const fs::path& path, const Imf::Header& checked, const Imf::Header& read) {
    const bool same = checked.dataWindow() == read.dataWindow() && checked.channels() == read.channels() &&
                      checked.compression() == read.compression() &&
                      checked.hasTileDescription() == read.hasTileDescription() &&
                      (!read.hasTileDescription() || checked.tileDescription() == read.tileDescription());
    if (!same) exr::fail(path, kChanged);
}

/// Fills the components whose name comes again later from the last one of that name.
void copy_repeated(char* pixels, std::span<const std::string> names, const Image& image) {
    const std::size_t stride = names.size() * sizeof(float);
    const std::size_t bytes = stride * std::size_t(image.width()) * std::size_t(image.height());
    for (std::size_t i = 0; i < names.size(); ++i) {
        const auto last = names.size() - 1 -
                          std::size_t(std::find(names.rbegin(), names.rend(), names[i]) - names.rbegin());
        if (last == i) continue;
        for (std::size_t at = 0; at < bytes; at += stride) {
            std::memcpy(pixels + at + i * sizeof(float), pixels + at + last * sizeof(float), sizeof(float));
        }
    }
}

}  // namespace

struct ExrFile::Impl {
    fs::path path;
    ReadLimits limits;
    std::unique_ptr<exr::FileStream> stream;
    exr::FileLayout layout;
    std::unique_ptr<Imf::MultiPartInputFile> file;
    std::vector<ExrPart> parts;

    Impl(OpenFile opened, const ReadLimits& file_limits);
    /// Unpacked ahead of the reads that will ask for it.
    struct Kept {
        ExrRequest request;
        Image image;
    };
    std::vector<Kept> kept;

    /// The library's, or none where a block is so large that one at a time is enough.
    int threads() const {
        return layout.largest_block_bytes > kThreadedBlockBytes ? 0 : Imf::globalThreadCount();
    }
    Image read(const ExrRequest& request);
    Image read_repeated(int part, const std::string& name, ComponentType type);
    void prefetch(int part, std::span<const ExrRequest> requests);
    Image add_slices(Imf::FrameBuffer& frame, const ExrRequest& request) const;
    void check_type(int part) const;
    void check_channels(int part, std::span<const std::string> names, ComponentType type) const;
    void check_bytes(int part, std::size_t count) const;
    void read_pixels(int part, const Imf::FrameBuffer& frame);
};

ExrFile::Impl::Impl(OpenFile opened, const ReadLimits& file_limits)
    : path(opened.path()), limits(file_limits) {
    bound_library();
    exr::translate_errors(path, ErrorKind::capture, "damaged header", [&] {
        stream = std::make_unique<exr::FileStream>(std::move(opened));
        layout = exr::read_layout(*stream, path, limits);
        // An incomplete part is refused, so the library looks for blocks only where all were found.
        file = std::make_unique<Imf::MultiPartInputFile>(*stream, threads(), !layout.found_blocks.empty());
        if (std::size_t(file->parts()) != layout.headers.size()) exr::fail(path, kChanged);
        for (int i = 0; i < file->parts(); ++i) {
            require_same_pixels(path, layout.headers[std::size_t(i)], file->header(i));
            parts.push_back(exr::describe_part(file->header(i)));
        }
    });
}

void ExrFile::Impl::check_type(int part) const {
    const ExrPart& info = parts[std::size_t(part)];
    if (info.type == Imf::SCANLINEIMAGE || info.type == Imf::TILEDIMAGE) return;
    exr::fail(path, fmt::format("{} is of type '{}', {}", exr::part_label(parts, part), info.type,
                                info.is_deep() ? "deep data is not supported; " + exr_flatten_remedy(path)
                                               : "which is not supported"));
}

void ExrFile::Impl::check_channels(int part, std::span<const std::string> names, ComponentType type) const {
    const ExrPart& info = parts[std::size_t(part)];
    std::string missing;
    for (const std::string& name : names) {
        const auto found = std::ranges::find(info.channels, name, &ExrChannel::name);
        if (found == info.channels.end()) {
            missing += fmt::format("{}'{}'", missing.empty() ? "" : ", ", name);
            continue;
        }
        if (found->x_sampling != 1 || found->y_sampling != 1) {
            exr::fail(
                path,
                fmt::format(
                    "channel '{}' is subsampled {} x {}, which is not supported (convert the file to RGB "
                    "first)",
                    name, found->x_sampling, found->y_sampling));
        }
        if (type == ComponentType::uint32 && found->type != PixelType::uint32) {
            exr::fail(path, fmt::format("channel '{}' is of type {}, expected uint", name,
                                        pixel_type_name(found->type)));
        }
    }
    if (missing.empty()) return;
    exr::fail(path, fmt::format("{} has no channel {}; it has {}", exr::part_label(parts, part), missing,
                                list_channels(info)));
}

void ExrFile::Impl::check_bytes(int part, std::size_t count) const {
    const Window& window = parts[std::size_t(part)].data_window;
    const std::uint64_t bytes =
        std::uint64_t(window.width()) * std::uint64_t(window.height()) * count * sizeof(float);
    if (bytes <= limits.max_image_bytes) return;
    exr::fail(
        path,
        fmt::format("{} channels of {} x {} px take {} bytes, the limit is {} (crop the image or read fewer "
                    "channels)",
                    count, window.width(), window.height(), bytes, limits.max_image_bytes));
}

void ExrFile::Impl::read_pixels(int part, const Imf::FrameBuffer& frame) {
    if (exr::read_scan_lines(*stream, layout, part, frame, threads())) return;
    // Decoding buffers and positions, which the library would keep until the file is closed, also after an
    // error.
    struct CacheFlush {
        Imf::MultiPartInputFile& file;
        ~CacheFlush() { file.flushPartCache(); }
    } const flush{*file};
    if (parts[std::size_t(part)].type == Imf::TILEDIMAGE) {
        Imf::TiledInputPart input(*file, part);
        input.setFrameBuffer(frame);
        input.readTiles(0, input.numXTiles(0) - 1, 0, input.numYTiles(0) - 1, 0);
    } else {
        Imf::InputPart input(*file, part);
        input.setFrameBuffer(frame);
        const Window& window = parts[std::size_t(part)].data_window;
        input.readPixels(window.min_y, window.max_y);
    }
}

/// An image for the request, and the slices that fill it: one a name, so that of names asked for twice the
/// last is filled.
Image ExrFile::Impl::add_slices(Imf::FrameBuffer& frame, const ExrRequest& request) const {
    const Window& window = parts[std::size_t(request.part)].data_window;
    const std::vector<std::string>& names = request.channels;
    Image image(window.width(), window.height(), int(names.size()), request.type, FirstValues::unwritten);
    const std::size_t x_stride = names.size() * sizeof(float);
    const std::size_t y_stride = x_stride * std::size_t(window.width());
    const Imf::PixelType type = request.type == ComponentType::float32 ? Imf::FLOAT : Imf::UINT;
    for (std::size_t i = 0; i < names.size(); ++i)
        frame.insert(names[i], Imf::Slice::Make(type, bytes_of(image) + i * sizeof(float),
                                                exr::to_box(window), x_stride, y_stride));
    return image;
}

Image ExrFile::Impl::read(const ExrRequest& request) {
    const int part = request.part;
    assert(part >= 0 && std::size_t(part) < parts.size());
    const auto ahead = std::ranges::find(kept, request, &Kept::request);
    if (ahead != kept.end()) {
        Image image = std::move(ahead->image);
        kept.erase(ahead);
        return image;
    }
    check_type(part);
    check_channels(part, request.channels, request.type);
    check_bytes(part, request.channels.size());
    return exr::translate_errors(path, ErrorKind::capture, "damaged pixel data", [&] {
        exr::check_blocks(*stream, path, layout, part);
        Imf::FrameBuffer frame;
        Image image = add_slices(frame, request);
        if (request.channels.empty()) return image;
        read_pixels(part, frame);
        copy_repeated(bytes_of(image), request.channels, image);
        return image;
    });
}

Image ExrFile::Impl::read_repeated(int part, const std::string& name, ComponentType type) {
    const ExrPart& info = parts[std::size_t(part)];
    const auto channel = std::ranges::find(info.channels, name, &ExrChannel::name);
    assert(channel != info.channels.end());
    const int across = channel->x_sampling, down = channel->y_sampling;
    if (across == 1 && down == 1) return read({part, {name}, type});
    check_type(part);
    check_bytes(part, 1);
    // read_layout refuses samplings that do not divide the window.
    Image samples(info.data_window.width() / across, info.data_window.height() / down, 1, type);
    exr::translate_errors(path, ErrorKind::capture, "damaged pixel data", [&] {
        exr::check_blocks(*stream, path, layout, part);
        Imf::FrameBuffer frame;
        frame.insert(name, Imf::Slice::Make(type == ComponentType::float32 ? Imf::FLOAT : Imf::UINT,
                                            bytes_of(samples), exr::to_box(info.data_window), sizeof(float),
                                            sizeof(float) * std::size_t(samples.width()), across, down));
        read_pixels(part, frame);
    });
    Image image(info.data_window.width(), info.data_window.height(), 1, type);
    const auto repeat = [&](const auto from, const auto to) {
        for (int y = 0; y < image.height(); ++y)
            for (int x = 0; x < image.width(); ++x)
                to[std::size_t(y) * std::size_t(image.width()) + std::size_t(x)] =
                    from[std::size_t(y / down) * std::size_t(samples.width()) + std::size_t(x / across)];
    };
    if (type == ComponentType::uint32) repeat(std::as_const(samples).uints(), image.uints());
    else repeat(std::as_const(samples).floats(), image.floats());
    return image;
}

void ExrFile::Impl::prefetch(int part, std::span<const ExrRequest> requests) {
    std::vector<Kept> together;
    Imf::FrameBuffer frame;
    std::set<std::string> channels;
    std::size_t count = 0;
    for (const ExrRequest& request : requests) {
        const std::set<std::string> its(request.channels.begin(), request.channels.end());
        const auto is_taken = [&](const std::string& name) { return channels.contains(name); };
        if (request.part != part || its.size() != request.channels.size() ||
            std::ranges::any_of(its, is_taken))
            continue;
        check_channels(part, request.channels, request.type);
        check_bytes(part, count += its.size());
        channels.insert(its.begin(), its.end());
        together.push_back({request, {}});
    }
    if (together.size() < 2) return;
    check_type(part);
    exr::translate_errors(path, ErrorKind::capture, "damaged pixel data", [&] {
        exr::check_blocks(*stream, path, layout, part);
        for (Kept& entry : together) entry.image = add_slices(frame, entry.request);
        read_pixels(part, frame);
    });
    std::ranges::move(together, std::back_inserter(kept));
}

ExrFile::ExrFile(const fs::path& path, const ReadLimits& limits) : ExrFile(exr::open_exr(path), limits) {}
ExrFile::ExrFile(OpenFile file, const ReadLimits& limits)
    : impl_(std::make_unique<Impl>(std::move(file), limits)) {}
ExrFile::~ExrFile() = default;
ExrFile::ExrFile(ExrFile&&) noexcept = default;
ExrFile& ExrFile::operator=(ExrFile&&) noexcept = default;

const fs::path& ExrFile::path() const {
    return impl_->path;
}
const std::vector<ExrPart>& ExrFile::parts() const {
    return impl_->parts;
}

Image ExrFile::read_floats(int part, std::span<const std::string> channels) const {
    return impl_->read({part, {channels.begin(), channels.end()}, ComponentType::float32});
}

Image ExrFile::read_uints(int part, std::span<const std::string> channels) const {
    return impl_->read({part, {channels.begin(), channels.end()}, ComponentType::uint32});
}

Image ExrFile::read_repeated(int part, const std::string& channel, ComponentType type) const {
    return impl_->read_repeated(part, channel, type);
}

void ExrFile::prefetch(std::span<const ExrRequest> requests) const {
    impl_->kept.clear();
    for (std::size_t part = 0; part < impl_->parts.size(); ++part) {
        try {
            impl_->prefetch(int(part), requests);
        } catch (const Error&) {
            // The read that asks for it fails in the same way, and says what it wanted.
        }
    }
}

DeepImage ExrFile::read_deep(int part, std::span<const std::string> channels) const {
    const ExrPart& info = impl_->parts[std::size_t(part)];
    if (!info.is_deep())
        exr::fail(path(), fmt::format("{} is of type '{}', not deep", exr::part_label(impl_->parts, part),
                                      info.type));
    impl_->check_channels(part, channels, ComponentType::float32);
    return exr::translate_errors(path(), ErrorKind::capture, "damaged pixel data", [&] {
        return exr::read_deep({impl_->path, impl_->limits, *impl_->stream, impl_->layout, *impl_->file}, part,
                              channels);
    });
}

Image ExrFile::read_luminance_chroma(int part) const {
    impl_->check_type(part);
    impl_->check_bytes(part, 4);
    // The library's converter of 3.1 takes a file's first part.
    if (part != 0) exr::fail(path(), "luminance-chroma is supported in the first part only");
    return exr::translate_errors(path(), ErrorKind::capture, "damaged pixel data", [&] {
        const Window& window = parts()[std::size_t(part)].data_window;
        exr::StreamView stream(*impl_->stream);
        Imf::RgbaInputFile input(stream, Imf::globalThreadCount());
        require_same_pixels(path(), impl_->file->header(part), input.header());
        exr::check_blocks(*impl_->stream, path(), impl_->layout, part);
        std::vector<Imf::Rgba> pixels(std::size_t(window.width()) * std::size_t(window.height()));
        const std::ptrdiff_t origin = window.min_x + std::ptrdiff_t(window.min_y) * window.width();
        input.setFrameBuffer(pixels.data() - origin, 1, std::size_t(window.width()));
        input.readPixels(window.min_y, window.max_y);
        Image image(window.width(), window.height(), 4);
        float* out = image.floats().data();
        for (const Imf::Rgba& pixel : pixels)
            for (const half value : {pixel.r, pixel.g, pixel.b, pixel.a}) *out++ = value;
        return image;
    });
}

void set_exr_threads(int count) {
    assert(count >= 0);
    Imf::setGlobalThreadCount(count);
}

int exr_threads() {
    return std::max(1, Imf::globalThreadCount());
}

}  // namespace aftershade
