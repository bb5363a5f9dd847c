#include "framework/file/exr_internal.h"
#include "framework/file/output_stream.h"

#include <Imath/ImathMatrix.h>
#include <Imath/ImathVec.h>
#include <Imath/half.h>
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfChromaticitiesAttribute.h>
#include <OpenEXR/ImfDeepFrameBuffer.h>
#include <OpenEXR/ImfDeepScanLineOutputFile.h>
#include <OpenEXR/ImfFloatAttribute.h>
#include <OpenEXR/ImfFloatVectorAttribute.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfFramesPerSecond.h>
#include <OpenEXR/ImfIntAttribute.h>
#include <OpenEXR/ImfMatrixAttribute.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfPartType.h>
#include <OpenEXR/ImfRationalAttribute.h>
#include <OpenEXR/ImfStringAttribute.h>
#include <OpenEXR/ImfThreading.h>
#include <OpenEXR/ImfVecAttribute.h>
#include <OpenEXR/OpenEXRConfig.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <optional>
#include <type_traits>

namespace aftershade {

namespace fs = std::filesystem;

namespace {

/// Say how this file's pixels are stored, or are set by the writer; never carried over. A preview would show
/// the old pixels.
constexpr std::string_view kOwnAttributes[] = {"dataWindow",     "displayWindow", "pixelAspectRatio",
                                               "channels",       "compression",   "type",
                                               "name",           "lineOrder",     "tiles",
                                               "chunkCount",     "version",       "maxSamplesPerPixel",
                                               "deepImageState", "preview",       "multiView"};

bool is_own_attribute(std::string_view name) {
    return std::ranges::find(kOwnAttributes, name) != std::end(kOwnAttributes);
}

[[noreturn]] void refuse(const fs::path& path, const std::string& what) {
    exr::fail(path, what, ErrorKind::output);
}

void check_name(const fs::path& path, const char* what, const std::string& name) {
    if (name.empty() || name.size() > exr::kMaxNameLength || name.find('\0') != std::string::npos) {
        refuse(path, fmt::format("{} name '{}' has {} bytes, 1 to {} are possible", what, name, name.size(),
                                 exr::kMaxNameLength));
    }
}

std::unique_ptr<Imf::Attribute> to_attribute(const std::string& name, const std::vector<float>& v) {
    if (name == "chromaticities" && v.size() == 8) {
        return std::make_unique<Imf::ChromaticitiesAttribute>(
            Imf::Chromaticities({v[0], v[1]}, {v[2], v[3]}, {v[4], v[5]}, {v[6], v[7]}));
    }
    switch (v.size()) {
        case 2: return std::make_unique<Imf::V2fAttribute>(Imath::V2f(v[0], v[1]));
        case 3: return std::make_unique<Imf::V3fAttribute>(Imath::V3f(v[0], v[1], v[2]));
        case 9: {
            Imath::M33f matrix;
            for (int i = 0; i < 9; ++i) matrix[i / 3][i % 3] = v[std::size_t(i)];
            return std::make_unique<Imf::M33fAttribute>(matrix);
        }
        case 16: {
            Imath::M44f matrix;
            for (int i = 0; i < 16; ++i) matrix[i / 4][i % 4] = v[std::size_t(i)];
            return std::make_unique<Imf::M44fAttribute>(matrix);
        }
        default: return std::make_unique<Imf::FloatVectorAttribute>(v);
    }
}

std::unique_ptr<Imf::Attribute> to_attribute(const std::string& name, const ExrValue& value) {
    if (const auto* text = std::get_if<std::string>(&value))
        return std::make_unique<Imf::StringAttribute>(*text);
    if (const auto* number = std::get_if<int>(&value)) return std::make_unique<Imf::IntAttribute>(*number);
    if (const auto* fps = std::get_if<float>(&value); fps && name == "framesPerSecond")
        return std::make_unique<Imf::RationalAttribute>(Imf::guessExactFps(double(*fps)));
    if (const auto* number = std::get_if<float>(&value))
        return std::make_unique<Imf::FloatAttribute>(*number);
    return to_attribute(name, std::get<std::vector<float>>(value));
}

/// The method of "zip" or "zip:1".
Imf::Compression find_compression(const fs::path& path, const std::string& text) {
    const std::string name = text.substr(0, text.find(':'));
    if (name != text && !exr_compression_level(text))
        refuse(path,
               fmt::format("compression '{}' has no such level; zip and zips have 1 (fastest) to 9, as in "
                           "zip:1",
                           text));
    const std::vector<std::string>& known = exr_compression_names();
    const auto found = std::ranges::find(known, name);
    if (found != known.end()) return Imf::Compression(found - known.begin());
    const auto* newer =
        std::ranges::find(exr::kCompressions, std::string_view(name), &exr::CompressionMethod::name);
    if (newer != exr::kCompressions.end())
        refuse(path, fmt::format("compression '{}' needs OpenEXR {}, this build has {}; there are {}", name,
                                 newer->since, OPENEXR_VERSION_STRING, fmt::join(known, ", ")));
    refuse(path, fmt::format("compression '{}' does not exist; there are {}", name, fmt::join(known, ", ")));
}

Imf::Header make_header(const fs::path& path, std::span<const ExrOutputChannel> channels,
                        const ExrWriteOptions& options) {
    Imf::Header header(exr::to_box(options.display_window), exr::to_box(options.data_window),
                       options.pixel_aspect);
    header.compression() = find_compression(path, options.compression);
    // OpenEXR's own level up to 3.3. From 3.4 on a header has -1, which libdeflate does not know.
    constexpr int kUsualLevel = 4;
    header.zipCompressionLevel() = exr_compression_level(options.compression).value_or(kUsualLevel);
    if (options.carry_over && options.carry_over->impl) {
        const Imf::Header& source = options.carry_over->impl->header;
        for (auto i = source.begin(); i != source.end(); ++i) {
            // Not inserted and then replaced: the type may differ, and Imf::Header::erase of 3.1 leaks the
            // attribute.
            if (is_own_attribute(i.name()) || options.attributes.contains(i.name()) ||
                std::ranges::find(options.left_behind, i.name()) != options.left_behind.end())
                continue;
            header.insert(i.name(), i.attribute());
        }
    }
    for (const auto& [name, value] : options.attributes) {
        check_name(path, "attribute", name);
        assert(!is_own_attribute(name));
        header.insert(name, *to_attribute(name, value));
    }
    for (const ExrOutputChannel& channel : channels) {
        check_name(path, "channel", channel.name);
        if (header.channels().findChannel(channel.name))
            refuse(path, fmt::format("channel '{}' is there twice", channel.name));
        header.channels().insert(channel.name, Imf::Channel(exr::to_imf(channel.type)));
    }
    return header;
}

/// Rounds to the nearest half, ties to even; beyond 65504 it becomes infinity, which `overflows` counts.
std::vector<half> to_halfs(const ExrOutputChannel& channel, std::size_t& overflows) {
    const std::span<const float> from = channel.image->floats();
    const auto stride = std::size_t(channel.image->channels());
    std::vector<half> result(from.size() / stride);
    for (std::size_t i = 0; i < result.size(); ++i) {
        const float value = from[i * stride + std::size_t(channel.component)];
        result[i] = half(value);
        if (result[i].isInfinity() && std::isfinite(value)) ++overflows;
    }
    return result;
}

/// The images as Imf reads them, and the halfs it needs for that.
class Planes {
public:
    Planes(std::span<const ExrOutputChannel> channels, const Imath::Box2i& window) : window_(window) {
        for (const ExrOutputChannel& channel : channels) add(channel);
    }
    const Imf::FrameBuffer& frame() const { return frame_; }
    const std::vector<HalfOverflow>& overflows() const { return overflows_; }

private:
    void add(const ExrOutputChannel& channel) {
        const Image& image = *channel.image;
        assert(channel.component >= 0 && channel.component < image.channels());
        assert((image.type() == ComponentType::uint32) == (channel.type == PixelType::uint32));
        if (channel.type == PixelType::half) {
            std::size_t overflows = 0;
            halfs_.push_back(to_halfs(channel, overflows));
            if (overflows > 0) overflows_.push_back({channel.name, overflows});
            insert(channel, halfs_.back().data(), sizeof(half));
        } else if (channel.type == PixelType::float32) {
            insert(channel, image.floats().data() + channel.component,
                   std::size_t(image.channels()) * sizeof(float));
        } else {
            insert(channel, image.uints().data() + channel.component,
                   std::size_t(image.channels()) * sizeof(float));
        }
    }

    void insert(const ExrOutputChannel& channel, const void* pixels, std::size_t x_stride) {
        const std::size_t y_stride = x_stride * std::size_t(channel.image->width());
        frame_.insert(channel.name,
                      Imf::Slice::Make(exr::to_imf(channel.type), pixels, window_, x_stride, y_stride));
    }

    Imath::Box2i window_;
    std::vector<std::vector<half>> halfs_;
    std::vector<HalfOverflow> overflows_;
    Imf::FrameBuffer frame_;
};

/// Keeps the first failure: Imf::OutputFile writes its block table in the destructor and swallows what goes
/// wrong there.
class ExrOutputStream final : public Imf::OStream {
public:
    explicit ExrOutputStream(const fs::path& path) : Imf::OStream(path.c_str()), stream_(path) {}

    void write(const char bytes[], int count) override {
        guarded([&] { stream_.write(bytes, std::size_t(count)); });
        position_ += std::uint64_t(count);
    }
    std::uint64_t tellp() override { return position_; }
    void seekp(std::uint64_t position) override {
        guarded([&] { stream_.seek(position); });
        position_ = position;
    }

    void commit() {
        if (failure_) throw Error(*failure_);
        stream_.commit();
    }

private:
    template <class Work>
    void guarded(Work&& work) {
        try {
            work();
        } catch (const Error& error) {
            if (!failure_) failure_ = error;
            throw;
        }
    }

    OutputStream stream_;
    std::uint64_t position_ = 0;
    std::optional<Error> failure_;
};

}  // namespace

std::vector<HalfOverflow> write_exr(const fs::path& path, std::span<const ExrOutputChannel> channels,
                                    const ExrWriteOptions& options) {
    assert(!channels.empty());
    for ([[maybe_unused]] const ExrOutputChannel& channel : channels) {
        assert(channel.image && channel.image->width() == options.data_window.width() &&
               channel.image->height() == options.data_window.height());
        assert(channel.component >= 0 && channel.component < channel.image->channels());
        assert((channel.image->type() == ComponentType::uint32) == (channel.type == PixelType::uint32));
    }
    return exr::translate_errors(path, ErrorKind::output, "cannot be written", [&] {
        const Imf::Header header = make_header(path, channels, options);
        ExrOutputStream stream(path);
        if (exr::is_scan_line_method(header.compression())) {
            std::vector<HalfOverflow> overflows = exr::write_scan_lines(stream, header, channels);
            stream.commit();
            return overflows;
        }
        const Planes planes(channels, header.dataWindow());
        {
            Imf::OutputFile file(stream, header, Imf::globalThreadCount());
            file.setFrameBuffer(planes.frame());
            file.writePixels(options.data_window.height());
        }
        stream.commit();
        return planes.overflows();
    });
}

void write_deep_exr(const fs::path& path, const DeepImage& image, const ExrWriteOptions& options) {
    exr::translate_errors(path, ErrorKind::output, "cannot be written", [&] {
        Imf::Header header = make_header(path, {}, options);
        header.setType(Imf::DEEPSCANLINE);
        const Imath::Box2i& window = header.dataWindow();
        const auto width = std::size_t(image.width);
        const std::ptrdiff_t origin = window.min.x + std::ptrdiff_t(window.min.y) * image.width;
        std::vector<std::uint32_t> counts;
        for (std::size_t i = 0; i < image.pixel_count(); ++i)
            counts.push_back(image.first[i + 1] - image.first[i]);
        Imf::DeepFrameBuffer frame;
        frame.insertSampleCountSlice(Imf::Slice(Imf::UINT, reinterpret_cast<char*>(counts.data() - origin),
                                                sizeof(std::uint32_t), sizeof(std::uint32_t) * width));
        std::vector<std::vector<const char*>> pointers;
        for (const DeepImage::Channel& channel : image.channels) {
            check_name(path, "channel", channel.name);
            const Imf::PixelType type = channel.uints.empty() ? Imf::FLOAT : Imf::UINT;
            const char* const values = channel.uints.empty()
                                           ? reinterpret_cast<const char*>(channel.floats.data())
                                           : reinterpret_cast<const char*>(channel.uints.data());
            header.channels().insert(channel.name, Imf::Channel(type));
            std::vector<const char*>& own = pointers.emplace_back();
            for (std::size_t i = 0; i < counts.size(); ++i)
                own.push_back(values + sizeof(float) * image.first[i]);
            frame.insert(channel.name, Imf::DeepSlice(type, reinterpret_cast<char*>(own.data() - origin),
                                                      sizeof(char*), sizeof(char*) * width, sizeof(float)));
        }
        ExrOutputStream stream(path);
        {
            Imf::DeepScanLineOutputFile file(stream, header, Imf::globalThreadCount());
            file.setFrameBuffer(frame);
            file.writePixels(image.height);
        }
        stream.commit();
    });
}

}  // namespace aftershade
