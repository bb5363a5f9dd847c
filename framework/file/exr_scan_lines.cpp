// Blocks of scan lines straight from the file to the caller's pixels. OpenEXR 3.1 unpacks with zlib, orders
// all channels of a block and copies value by value; here only the wanted channels leave the unpacked block.
#include "framework/file/deflate.h"
#include "framework/file/exr_internal.h"
#include "framework/file/exr_zip.h"

#include <Imath/half.h>
#include <OpenEXR/IlmThreadPool.h>
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfPartType.h>
#include <OpenEXR/ImfThreading.h>

#include <algorithm>
#include <atomic>
#include <cstring>
#include <functional>

namespace aftershade::exr {

namespace {

/// A channel that is wanted: where it lies in a line of a block, and where it goes.
struct WantedChannel {
    Imf::PixelType stored = Imf::FLOAT;
    std::size_t line_offset = 0;  ///< bytes
    Imf::Slice slice;
};

/// Neighbouring channels of a line that are all wanted, or none of them.
struct LinePiece {
    std::size_t bytes = 0;
    bool is_wanted = false;
};

/// How the lines of one part are stored, and which of their channels are wanted.
struct ScanLines {
    const Imf::Header& header;
    std::vector<std::uint64_t> offsets;
    std::int32_t part = -1;  ///< as in the heads of its blocks; -1 where they name none
    std::size_t width_px = 0;
    std::size_t line_bytes = 0;
    std::vector<WantedChannel> wanted;
    std::vector<LinePiece> pieces;

    bool is_zip() const { return header.compression() != Imf::NO_COMPRESSION; }
};

bool is_plain(const Imf::Header& header) {
    if (header.type() != Imf::SCANLINEIMAGE || !is_scan_line_method(header.compression())) return false;
    for (auto i = header.channels().begin(); i != header.channels().end(); ++i)
        if (i.channel().xSampling != 1 || i.channel().ySampling != 1) return false;
    return true;
}

/// False where a slice wants what the library's conversions are needed for.
bool choose_channels(ScanLines& lines, const Imf::FrameBuffer& frame) {
    int unmatched = 0;
    const Imf::ChannelList& channels = lines.header.channels();
    for (auto i = channels.begin(); i != channels.end(); ++i) {
        const Imf::PixelType stored = i.channel().type;
        const std::size_t bytes = lines.width_px * (stored == Imf::HALF ? 2 : 4);
        const Imf::Slice* const slice = frame.findSlice(i.name());
        if (lines.pieces.empty() || lines.pieces.back().is_wanted != (slice != nullptr))
            lines.pieces.push_back({0, slice != nullptr});
        lines.pieces.back().bytes += bytes;
        if (slice) {
            ++unmatched;
            if (slice->type != Imf::FLOAT && (slice->type != Imf::UINT || stored != Imf::UINT)) return false;
            lines.wanted.push_back({stored, lines.line_bytes, *slice});
        }
        lines.line_bytes += bytes;
    }
    for (auto slice = frame.begin(); slice != frame.end(); ++slice) --unmatched;
    return unmatched == 0;
}

void scatter_line(const WantedChannel& channel, const char* values, std::size_t count, char* to) {
    const std::size_t stride = channel.slice.xStride;
    const auto convert = [&]<class Stored>(Stored) {
        for (std::size_t x = 0; x < count; ++x, to += stride) {
            Stored stored;
            std::memcpy(&stored, values + x * sizeof stored, sizeof stored);
            const float value = float(stored);
            std::memcpy(to, &value, sizeof value);
        }
    };
    if (channel.stored == Imf::HALF) return convert(Imath::half());
    if (channel.stored != channel.slice.type) return convert(std::uint32_t());
    for (std::size_t x = 0; x < count; ++x, to += stride) std::memcpy(to, values + 4 * x, 4);
}

/// Reads and unpacks blocks one after another. [one thread]
class BlockReader {
public:
    BlockReader(FileStream& file, const ScanLines& lines) : file_(file), lines_(lines) {}

    /// False where the block is not as it should be.
    bool read(std::uint64_t index) {
        const Imath::Box2i box = block_box(lines_.header, index);
        const auto count = std::size_t(box.max.y - box.min.y + 1);
        raw_.resize(count * lines_.line_bytes);
        bool is_split = false;
        if (!fetch(index, box.min.y, is_split)) return false;
        line_.resize(lines_.width_px * sizeof(float));
        for (std::size_t y = 0; y < count; ++y)
            for (const WantedChannel& channel : lines_.wanted) {
                const Imf::Slice& slice = channel.slice;
                const std::ptrdiff_t origin = std::ptrdiff_t(slice.yStride) * (box.min.y + int(y)) +
                                              std::ptrdiff_t(slice.xStride) * box.min.x;
                scatter_line(channel, line_of(channel, y, is_split), lines_.width_px, slice.base + origin);
            }
        return true;
    }

private:
    /// Fills raw_; `is_split` is then whether its even bytes stand before its odd ones.
    bool fetch(std::uint64_t index, int first_line, bool& is_split) {
        std::array<std::int32_t, 3> head = {};
        const std::size_t words = lines_.part >= 0 ? 3 : 2;
        std::uint64_t at = lines_.offsets[index];
        file_.read_at(at, {reinterpret_cast<char*>(head.data()), words * sizeof head[0]});
        at += words * sizeof head[0];
        if (lines_.part >= 0 && head[0] != lines_.part) return false;
        const std::int32_t stored = head[words - 1];
        if (head[words - 2] != first_line || stored < 0 || std::size_t(stored) > raw_.size()) return false;
        // What packing would not make smaller is stored as it is.
        if (std::size_t(stored) == raw_.size()) {
            file_.read_at(at, raw_);
            return true;
        }
        if (!lines_.is_zip()) return false;
        packed_.resize(std::size_t(stored));
        file_.read_at(at, packed_);
        if (!inflater_.unpack(packed_, raw_)) return false;
        undo_wanted();
        is_split = true;
        return true;
    }

    /// The even bytes of all lines stand before the odd ones, and the differences run through both.
    void undo_wanted() {
        unsigned char before = 128;  // the first byte has none before it
        const std::size_t line_count = raw_.size() / lines_.line_bytes;
        char* at = raw_.data();
        for (std::size_t y = 0; y < 2 * line_count; ++y)
            for (const LinePiece& piece : lines_.pieces) {
                const std::span<char> bytes(at, piece.bytes / 2);
                before =
                    piece.is_wanted ? undo_differences(bytes, before) : last_of_differences(bytes, before);
                at += bytes.size();
            }
    }

    /// The stored values of a channel in line `y` of the block, in order.
    const char* line_of(const WantedChannel& channel, std::size_t y, bool is_split) {
        const std::size_t offset = y * lines_.line_bytes + channel.line_offset;
        if (!is_split) return raw_.data() + offset;
        // All offsets and sizes are even: values have 2 or 4 bytes.
        const std::size_t bytes = lines_.width_px * (channel.stored == Imf::HALF ? 2 : 4);
        const char* const even = raw_.data() + offset / 2;
        interleave_halves(even, even + raw_.size() / 2, bytes / 2, line_.data());
        return line_.data();
    }

    FileStream& file_;
    const ScanLines& lines_;
    Inflater inflater_;
    std::vector<char> packed_, raw_, line_;
};

/// The blocks that nobody has taken yet; the first fault ends the work.
struct BlockQueue {
    FileStream& file;
    const ScanLines& lines;
    std::atomic<std::uint64_t> next = 0;
    std::atomic<bool> has_fault = false;

    void work() noexcept {
        try {
            BlockReader reader(file, lines);
            for (std::uint64_t i = next++; i < lines.offsets.size() && !has_fault; i = next++)
                if (!reader.read(i)) has_fault = true;
        } catch (...) {
            has_fault = true;  // the library reads the part again, and reports what it finds
        }
    }
};

/// Work of several threads of the pool. `order` repeats the pool's own ordering where a thread sanitizer sees
/// it: the library's locks are in code that is not instrumented.
struct SharedWork {
    const std::function<void()>& run;
    std::atomic<int> order = 0;
};

class SharedTask final : public IlmThread::Task {
public:
    SharedTask(IlmThread::TaskGroup* group, SharedWork& work) : IlmThread::Task(group), work_(work) {}
    void execute() override {
        work_.order.fetch_add(1, std::memory_order_acq_rel);
        work_.run();
        work_.order.fetch_add(1, std::memory_order_release);
    }

private:
    SharedWork& work_;
};

}  // namespace

void run_on_threads(int threads, std::size_t jobs, const std::function<void()>& work) {
    if (threads < 2 || jobs < 2) return work();
    SharedWork shared{.run = work};
    shared.order.store(1, std::memory_order_release);
    {
        IlmThread::TaskGroup group;  // whose end is that of its tasks
        // This thread works too: of two that it woke, Linux leaves both on one core for a while.
        for (std::size_t i = 1; i < std::min(std::size_t(threads), jobs); ++i)
            IlmThread::ThreadPool::addGlobalTask(new SharedTask(&group, shared));
        work();
    }
    shared.order.load(std::memory_order_acquire);
}

bool read_scan_lines(FileStream& file, const FileLayout& layout, int part, const Imf::FrameBuffer& frame,
                     int threads) {
    const Imf::Header& header = layout.headers[std::size_t(part)];
    if (!is_plain(header)) return false;
    ScanLines lines{.header = header,
                    .offsets = part_offsets(file, layout, part),
                    .part = layout.multi_part ? part : -1,
                    .width_px = std::size_t(to_window(header.dataWindow()).width()),
                    .wanted = {},
                    .pieces = {}};
    if (!choose_channels(lines, frame)) return false;
    BlockQueue queue{.file = file, .lines = lines};
    run_on_threads(threads, lines.offsets.size(), [&] { queue.work(); });
    return !queue.has_fault;
}

}  // namespace aftershade::exr
