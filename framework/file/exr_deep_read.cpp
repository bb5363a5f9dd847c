// Deep parts: what their blocks claim is checked before the library allocates anything for them.
#include "framework/base/option.h"
#include "framework/file/exr_internal.h"

#include <Imath/ImathBox.h>
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfDeepFrameBuffer.h>
#include <OpenEXR/ImfDeepScanLineInputPart.h>
#include <OpenEXR/ImfDeepTiledInputPart.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfMultiPartInputFile.h>
#include <OpenEXR/ImfPartType.h>
#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <numeric>

namespace aftershade::exr {

namespace fs = std::filesystem;

namespace {

/// The sizes in the head of a deep block (openexr.com, "OpenEXR File Layout", deep data).
struct DeepSizes {
    std::uint64_t packed_counts = 0;
    std::uint64_t packed_samples = 0;
    std::uint64_t samples = 0;  ///< unpacked
};

// Deflate makes at most 1032 bytes out of one (zlib, "Technical Details"), and run lengths fewer.
constexpr std::uint64_t kMostOfOneByte = 1032;
constexpr std::uint64_t kSlackBytes = 64;

std::uint64_t pixels_of(const Imath::Box2i& box) {
    return std::uint64_t(box.max.x - box.min.x + 1) * std::uint64_t(box.max.y - box.min.y + 1);
}

std::uint64_t bytes_per_sample(const Imf::Header& header) {
    std::uint64_t bytes = 0;
    for (auto i = header.channels().begin(); i != header.channels().end(); ++i)
        bytes += i.channel().type == Imf::HALF ? 2 : 4;
    return bytes;
}

/// What is wrong with the sizes of a block; "" where they may be true.
std::string size_fault(const DeepSizes& sizes, const Imf::Header& header, std::uint64_t pixels) {
    const bool is_packed = header.compression() != Imf::NO_COMPRESSION;
    const auto is_large_enough = [&](std::uint64_t packed, std::uint64_t bytes) {
        return is_packed ? packed * kMostOfOneByte + kSlackBytes >= bytes : packed >= bytes;
    };
    const auto fits = [&](std::uint64_t packed, std::uint64_t bytes) {
        return packed <= bytes && is_large_enough(packed, bytes);
    };
    // At the right and at the bottom, the library packs counts into at most what those of a whole tile take.
    const std::uint64_t most_counts =
        is_tiled_part(header)
            ? std::max(pixels, std::uint64_t(header.tileDescription().xSize) * header.tileDescription().ySize)
            : pixels;
    if (sizes.packed_counts == 0 || sizes.packed_counts > most_counts * 4 ||
        !is_large_enough(sizes.packed_counts, pixels * 4))
        return fmt::format("its {} sample counts are stored in {} bytes", pixels, sizes.packed_counts);
    if (!fits(sizes.packed_samples, sizes.samples))
        return fmt::format("its samples, {} bytes, are stored in {}", sizes.samples, sizes.packed_samples);
    if (const std::uint64_t each = bytes_per_sample(header); each == 0 || sizes.samples % each != 0)
        return fmt::format("its samples take {} bytes, and one takes {}", sizes.samples, each);
    return "";
}

/// The unpacked bytes of each block of a deep part, all of which lie whole in the file.
std::vector<std::uint64_t> check_deep_blocks(const DeepSource& source, int part) {
    const Imf::Header& header = source.layout.headers[std::size_t(part)];
    FileStream& file = source.stream;
    const std::vector<std::uint64_t> offsets =
        block_offsets(file, header, source.layout.block_tables[std::size_t(part)]);
    require_no_missing_block(source.path, header, offsets);
    const std::size_t words = (source.layout.multi_part ? 1u : 0u) + (is_tiled_part(header) ? 4u : 1u);
    std::vector<std::uint64_t> bytes;
    for (std::uint64_t i = 0; i < offsets.size(); ++i) {
        const std::uint64_t head = words * 4 + sizeof(DeepSizes);
        const auto cut_off = [&] {
            fail(source.path,
                 fmt::format("cut off or damaged: the file has {} bytes, {} should reach beyond that",
                             file.byte_count(), block_label(header, i)));
        };
        if (offsets[i] > file.byte_count() || file.byte_count() - offsets[i] < head) cut_off();
        DeepSizes sizes;
        file.read_at(offsets[i] + words * 4, {reinterpret_cast<char*>(&sizes), sizeof sizes});
        const std::uint64_t left = file.byte_count() - offsets[i] - head;
        if (sizes.packed_counts > left || sizes.packed_samples > left - sizes.packed_counts) cut_off();
        if (const std::string fault = size_fault(sizes, header, pixels_of(block_box(header, i)));
            !fault.empty())
            fail(source.path, fmt::format("damaged: {}: {}", block_label(header, i), fault));
        if (sizes.samples > source.limits.max_image_bytes)
            fail(source.path,
                 fmt::format("{} has {} bytes of samples, the limit is {} ({})", block_label(header, i),
                             sizes.samples, source.limits.max_image_bytes, spelled(Option::max_image_bytes)));
        bytes.push_back(sizes.samples);
    }
    return bytes;
}

/// Reads the counts, then a band of rows after the other: the library wants a pointer for each pixel of each
/// channel, which would take more than the samples.
class DeepReader {
public:
    DeepReader(const DeepSource& source, int part, std::span<const std::string> names)
        : source_(source), part_(part), header_(source.layout.headers[std::size_t(part)]) {
        const Imath::Box2i& box = header_.dataWindow();
        image_.width = box.max.x - box.min.x + 1;
        image_.height = box.max.y - box.min.y + 1;
        for (const std::string& name : names) image_.channels.push_back({name});
    }

    DeepImage read() {
        const std::vector<std::uint64_t> bytes = check_deep_blocks(source_, part_);
        counts_.resize(image_.pixel_count());
        if (is_tiled_part(header_)) read_tiles(bytes);
        else read_lines(bytes);
        return std::move(image_);
    }

private:
    static constexpr int kLinesPerBand = 32;

    void read_lines(const std::vector<std::uint64_t>& bytes) {
        Imf::DeepScanLineInputPart input(source_.file, part_);
        const Imath::Box2i& box = header_.dataWindow();
        input.setFrameBuffer(frame(box.min.y, kLinesPerBand));
        input.readPixelSampleCounts(box.min.y, box.max.y);
        allocate(bytes);
        if (image_.channels.empty()) return;
        for (int y = box.min.y; y <= box.max.y; y += kLinesPerBand) {
            const int last = std::min(box.max.y, y + kLinesPerBand - 1);
            input.setFrameBuffer(frame(y, kLinesPerBand));
            read_counts_again(y, last, [&] { input.readPixelSampleCounts(y, last); });
            point(y, last);
            input.readPixels(y, last);
        }
    }

    void read_tiles(const std::vector<std::uint64_t>& bytes) {
        Imf::DeepTiledInputPart input(source_.file, part_);
        const Imath::Box2i& box = header_.dataWindow();
        const int side = int(input.tileYSize());
        const int across = input.numXTiles(0), down = input.numYTiles(0);
        input.setFrameBuffer(frame(box.min.y, side));
        input.readPixelSampleCounts(0, across - 1, 0, down - 1, 0);
        allocate(bytes);
        if (image_.channels.empty()) return;
        for (int row = 0; row < down; ++row) {
            const int y = box.min.y + row * side, last = std::min(box.max.y, y + side - 1);
            input.setFrameBuffer(frame(y, side));
            read_counts_again(y, last, [&] { input.readPixelSampleCounts(0, across - 1, row, row, 0); });
            point(y, last);
            input.readTiles(0, across - 1, row, row, 0);
        }
    }

    /// Slices over the counts of all pixels, and over the pointers of a band that begins with row `y`.
    Imf::DeepFrameBuffer frame(int y, int rows) {
        const Imath::Box2i& box = header_.dataWindow();
        const std::ptrdiff_t width = image_.width;
        Imf::DeepFrameBuffer frame;
        frame.insertSampleCountSlice(Imf::Slice(
            Imf::UINT,
            reinterpret_cast<char*>(counts_.data() - box.min.x - std::ptrdiff_t(box.min.y) * width),
            sizeof(std::uint32_t), sizeof(std::uint32_t) * std::size_t(width)));
        pointers_.resize(image_.channels.size());
        for (std::size_t c = 0; c < image_.channels.size(); ++c) {
            pointers_[c].resize(std::size_t(width) * std::size_t(rows));
            char** const base = pointers_[c].data() - box.min.x - std::ptrdiff_t(y) * width;
            const std::string& name = image_.channels[c].name;
            const bool is_uint = header_.channels().findChannel(name)->type == Imf::UINT;
            frame.insert(name,
                         Imf::DeepSlice(is_uint ? Imf::UINT : Imf::FLOAT, reinterpret_cast<char*>(base),
                                        sizeof(char*), sizeof(char*) * std::size_t(width), sizeof(float)));
        }
        return frame;
    }

    /// The library forgets the counts with each new frame buffer, and writes as many samples as it finds now.
    template <class Read>
    void read_counts_again(int y, int last, const Read& read) {
        const std::ptrdiff_t width = image_.width, top = header_.dataWindow().min.y;
        const auto begin = counts_.begin() + (y - top) * width,
                   end = counts_.begin() + (last - top + 1) * width;
        const std::vector<std::uint32_t> before(begin, end);
        read();
        if (!std::equal(begin, end, before.begin()))
            fail(source_.path, "was changed while it was read (render to another name and rename the file)");
    }

    /// Where the samples of rows y to last go.
    void point(int y, int last) {
        const std::size_t width = std::size_t(image_.width);
        const std::size_t begin = std::size_t(y - header_.dataWindow().min.y) * width;
        const std::size_t count = std::size_t(last - y + 1) * width;
        for (std::size_t c = 0; c < image_.channels.size(); ++c) {
            DeepImage::Channel& channel = image_.channels[c];
            char* const values = channel.uints.empty() ? reinterpret_cast<char*>(channel.floats.data())
                                                       : reinterpret_cast<char*>(channel.uints.data());
            for (std::size_t i = 0; i < count; ++i)
                pointers_[c][i] = values + std::size_t(image_.first[begin + i]) * sizeof(float);
        }
    }

    void allocate(const std::vector<std::uint64_t>& bytes) {
        require_true_counts(bytes);
        const std::uint64_t samples = std::reduce(counts_.begin(), counts_.end(), std::uint64_t(0));
        const std::uint64_t wanted = samples * image_.channels.size() * sizeof(float);
        if (wanted > source_.limits.max_image_bytes || samples > std::numeric_limits<std::uint32_t>::max())
            fail(source_.path,
                 fmt::format("{} channels of {} deep samples take {} bytes, the limit is {} ({}, or {})",
                             image_.channels.size(), samples, wanted, source_.limits.max_image_bytes,
                             spelled(Option::max_image_bytes), exr_flatten_remedy(source_.path)));
        image_.first.resize(counts_.size() + 1);
        for (std::size_t i = 0; i < counts_.size(); ++i) image_.first[i + 1] = image_.first[i] + counts_[i];
        for (DeepImage::Channel& channel : image_.channels) {
            if (header_.channels().findChannel(channel.name)->type == Imf::UINT)
                channel.uints.resize(samples);
            else channel.floats.resize(samples);
        }
    }

    /// The library copies as many samples as the counts say out of a block, however long that is.
    void require_true_counts(const std::vector<std::uint64_t>& bytes) const {
        const Imath::Box2i& all = header_.dataWindow();
        const std::uint64_t each = bytes_per_sample(header_);
        for (std::uint64_t i = 0; i < bytes.size(); ++i) {
            const Imath::Box2i box = block_box(header_, i);
            std::uint64_t samples = 0;
            for (int y = box.min.y; y <= box.max.y; ++y)
                for (int x = box.min.x; x <= box.max.x; ++x)
                    samples += counts_[std::size_t(y - all.min.y) * std::size_t(image_.width) +
                                       std::size_t(x - all.min.x)];
            if (samples * each != bytes[i])
                fail(source_.path,
                     fmt::format("damaged: {} counts {} samples of {} bytes, but holds {} bytes",
                                 block_label(header_, i), samples, each, bytes[i]));
        }
    }

    const DeepSource& source_;
    int part_;
    const Imf::Header& header_;
    DeepImage image_;
    std::vector<std::uint32_t> counts_;
    std::vector<std::vector<char*>> pointers_;  // by channel, of one band
};

}  // namespace

DeepImage read_deep(const DeepSource& source, int part, std::span<const std::string> names) {
    // Decoding buffers, which the library would keep until the file is closed.
    struct CacheFlush {
        Imf::MultiPartInputFile& file;
        ~CacheFlush() { file.flushPartCache(); }
    } const flush{source.file};
    return DeepReader(source, part, names).read();
}

}  // namespace aftershade::exr
