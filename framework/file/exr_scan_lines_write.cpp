// Blocks of scan lines straight from the caller's pixels to the file. OpenEXR 3.1 packs with zlib, and has
// halfs made of the whole picture first.
#include "framework/file/deflate.h"
#include "framework/file/exr_internal.h"
#include "framework/file/exr_zip.h"
#include "framework/file/half_runs.h"

#include <Imath/half.h>
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfThreading.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <condition_variable>
#include <cstring>
#include <map>
#include <mutex>

namespace aftershade::exr {

namespace {

/// Finite values that became infinite are added to `overflows`.
void append_halfs(const ExrOutputChannel& channel, std::size_t first, std::size_t count, char* to,
                  std::size_t& overflows) {
    const auto stride = std::size_t(channel.image->channels());
    const float* from = channel.image->floats().data() + first * stride + std::size_t(channel.component);
    std::array<float, kHalfRun> values = {};
    std::array<std::uint16_t, kHalfRun> halfs = {};
    for (std::size_t x = 0; x < count; x += kHalfRun) {
        const std::size_t run = std::min(kHalfRun, count - x);
        for (std::size_t i = 0; i < run; ++i, from += stride) values[i] = *from;
        if (!to_plain_halfs(values, halfs)) overflows += to_halfs(std::span(values).first(run), halfs);
        std::memcpy(to + x * sizeof halfs[0], halfs.data(), run * sizeof halfs[0]);
    }
}

void append_words(const ExrOutputChannel& channel, std::size_t first, std::size_t count, char* to) {
    const auto stride = std::size_t(channel.image->channels());
    const std::size_t from = first * stride + std::size_t(channel.component);
    const char* const words = channel.type == PixelType::uint32
                                  ? reinterpret_cast<const char*>(channel.image->uints().data())
                                  : reinterpret_cast<const char*>(channel.image->floats().data());
    for (std::size_t x = 0; x < count; ++x) std::memcpy(to + 4 * x, words + 4 * (from + x * stride), 4);
}

/// What is written, and the turns of those who write it.
class BlockWriter {
public:
    BlockWriter(Imf::OStream& stream, const Imf::Header& header, std::span<const ExrOutputChannel> channels)
        : stream_(stream), header_(header), overflows_(channels.size()) {
        // As they stand in a block: in the header's order.
        for (auto i = header.channels().begin(); i != header.channels().end(); ++i) {
            const auto* const found =
                std::to_address(std::ranges::find(channels, i.name(), &ExrOutputChannel::name));
            stored_.push_back({found, std::size_t(found - channels.data())});
            pixel_bytes_ += found->type == PixelType::half ? 2 : 4;
        }
        {
            // The library writes the header and an empty table, and no pixel.
            const Imf::OutputFile file(stream, header, 0);
            table_end_ = stream.tellp();
        }
        stream.seekp(table_end_);
        offsets_.resize(scan_line_blocks(header));
    }

    std::size_t block_count() const { return offsets_.size(); }

    /// Packs and writes blocks until none is left. [any number of threads at a time]
    void work() noexcept {
        try {
            Scratch scratch(header_.zipCompressionLevel());
            for (std::size_t i = next_++; i < offsets_.size(); i = next_++)
                if (!write_in_order(i, pack(i, scratch))) return;
        } catch (...) {
            const std::lock_guard lock(mutex_);
            if (!failure_) failure_ = std::current_exception();
            turn_.notify_all();
        }
    }

    /// Throws what a thread failed with; else writes the table, and returns the overflows by channel.
    std::vector<std::size_t> finish() {
        if (failure_) std::rethrow_exception(failure_);
        const std::size_t bytes = offsets_.size() * sizeof offsets_[0];
        stream_.seekp(table_end_ - bytes);
        stream_.write(reinterpret_cast<const char*>(offsets_.data()), int(bytes));
        return {overflows_.begin(), overflows_.end()};
    }

private:
    struct StoredChannel {
        const ExrOutputChannel* channel;
        std::size_t index;  ///< among those given
    };
    struct Scratch {
        explicit Scratch(int level) : deflater(level) {}
        Deflater deflater;
        std::vector<char> raw, split, packed;
    };

    /// The bytes of a block as they are stored. [refers to the scratch]
    std::span<const char> pack(std::size_t index, Scratch& scratch) {
        const Imath::Box2i box = block_box(header_, index);
        const Imath::Box2i& window = header_.dataWindow();
        const auto width = std::size_t(box.max.x - box.min.x + 1);
        const auto first = std::size_t(box.min.y - window.min.y),
                   lines = std::size_t(box.max.y - box.min.y + 1);
        scratch.raw.resize(lines * width * pixel_bytes_);
        char* to = scratch.raw.data();
        std::vector<std::size_t> overflows(overflows_.size());
        for (std::size_t y = first; y < first + lines; ++y)
            for (const StoredChannel& stored : stored_) {
                const bool is_half = stored.channel->type == PixelType::half;
                if (is_half) append_halfs(*stored.channel, y * width, width, to, overflows[stored.index]);
                else append_words(*stored.channel, y * width, width, to);
                to += width * (is_half ? 2 : 4);
            }
        for (std::size_t i = 0; i < overflows.size(); ++i) overflows_[i] += overflows[i];
        if (header_.compression() == Imf::NO_COMPRESSION) return scratch.raw;
        scratch.split.resize(scratch.raw.size());
        scratch.packed.resize(scratch.raw.size());
        split_halves(scratch.raw, scratch.packed.data());
        make_differences(scratch.packed, scratch.split.data());
        // What packing does not make smaller is stored as it is.
        const std::size_t packed =
            scratch.deflater.pack(scratch.split, {scratch.packed.data(), scratch.raw.size() - 1});
        return packed == 0 ? std::span<const char>(scratch.raw) : std::span(scratch.packed).first(packed);
    }

    /// Writes the block and those that waited for it; one whose turn it is not waits in memory, so that a
    /// thread that shares its core holds up no other. False where a block could not be written.
    bool write_in_order(std::size_t index, std::span<const char> bytes) {
        std::unique_lock lock(mutex_);
        turn_.wait(lock, [&] { return failure_ || written_ == index || waiting_.size() < kMostWaiting; });
        if (failure_) return false;
        if (written_ != index) {
            waiting_.emplace(index, std::vector(bytes.begin(), bytes.end()));
            return true;
        }
        write(bytes);
        while (!waiting_.empty() && waiting_.begin()->first == written_)
            write(waiting_.extract(waiting_.begin()).mapped());
        turn_.notify_all();
        return true;
    }

    /// The next block.
    void write(std::span<const char> bytes) {
        offsets_[written_] = stream_.tellp();
        const std::array<std::int32_t, 2> head = {block_box(header_, written_).min.y,
                                                  std::int32_t(bytes.size())};
        stream_.write(reinterpret_cast<const char*>(head.data()), int(sizeof head));
        stream_.write(bytes.data(), int(bytes.size()));
        ++written_;
    }

    static constexpr std::size_t kMostWaiting = 16;

    Imf::OStream& stream_;
    const Imf::Header& header_;
    std::vector<StoredChannel> stored_;
    std::size_t pixel_bytes_ = 0;
    std::uint64_t table_end_ = 0;
    std::vector<std::uint64_t> offsets_;
    std::vector<std::atomic<std::size_t>> overflows_;
    std::atomic<std::size_t> next_ = 0;
    std::mutex mutex_;
    std::condition_variable turn_;
    std::size_t written_ = 0;                             ///< blocks
    std::map<std::size_t, std::vector<char>> waiting_{};  ///< packed, by index
    std::exception_ptr failure_;
};

}  // namespace

bool is_scan_line_method(Imf::Compression method) {
    return method == Imf::NO_COMPRESSION || method == Imf::ZIPS_COMPRESSION || method == Imf::ZIP_COMPRESSION;
}

std::vector<HalfOverflow> write_scan_lines(Imf::OStream& stream, const Imf::Header& header,
                                           std::span<const ExrOutputChannel> channels) {
    BlockWriter writer(stream, header, channels);
    run_on_threads(Imf::globalThreadCount(), writer.block_count(), [&] { writer.work(); });
    std::vector<HalfOverflow> result;
    const std::vector<std::size_t> overflows = writer.finish();
    for (std::size_t i = 0; i < overflows.size(); ++i)
        if (overflows[i] > 0) result.push_back({channels[i].name, overflows[i]});
    return result;
}

}  // namespace aftershade::exr
