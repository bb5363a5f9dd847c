// Replays the texel fetches of one pass of an effect through the caches of GPUs. scripts/bench bandwidth says
// which, as JSON on stdin, in words of its own copy of the shaders, which record each fetch; it reads JSON
// from stdout.
#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <iostream>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "framework/capture/capture.h"
#include "framework/effect/registry.h"
#include "framework/gpu/buffer.h"
#include "framework/gpu/context.h"
#include "framework/look/look.h"
#include "framework/render/renderer.h"
#include "tests/backends.h"
#include "tests/bench/cache_model.h"

#include <glad/gl.h>

namespace aftershade::bench {
namespace {

using nlohmann::json;

/// Words of the buffer of records (scripts/measure/traced_shaders.py): width, first row and number of rows of
/// the band that is recorded, records a pixel; then for each pixel of the band its number of fetches and its
/// records.
constexpr unsigned kBinding = 15;
constexpr std::size_t kHeadWords = 4, kBufferBytes = std::size_t(120) << 20;  // llvmpipe's limit is 128 MiB
constexpr int kBlock = 16;                      // px; a block of threads is a square
constexpr int kWarpWidth = 8, kWarpHeight = 4;  // px

/// A record: x and y of a texel in 11 bits each, its level in 3, the number of the texture in 6; the topmost
/// bit where the four texels to its right and below are fetched.
struct Record {
    int x, y, level, texture;
    bool is_filtered;
};

Record unpack(std::uint32_t word) {
    return {int(word & 2047U), int(word >> 11 & 2047U), int(word >> 22 & 7U), int(word >> 25 & 63U),
            word >> 31 != 0};
}

/// Where texels of a texture with mips lie: blocks of one line of the cache, nearly square, in rows; levels
/// one after another.
class Layout {
public:
    Layout(std::uint64_t base, int width, int height, int texel_bytes)
        : base_(base), texel_bytes_(texel_bytes) {
        const int texels = int(kLineBytes) / texel_bytes;
        across_ = 1 << ((std::bit_width(unsigned(texels)) - 1 + 1) / 2);
        down_ = texels / across_;
        for (int level = 0; level < 8; ++level) {
            const int w = std::max(width >> level, 1), h = std::max(height >> level, 1);
            const std::uint64_t in_row = std::uint64_t((w + across_ - 1) / across_);
            levels_.push_back({end_, in_row});
            end_ += in_row * std::uint64_t((h + down_ - 1) / down_) * kLineBytes;
        }
    }
    std::uint64_t bytes() const { return end_; }
    std::uint64_t address(int x, int y, int level) const {
        const Level& at = levels_[std::size_t(level)];
        const std::uint64_t line = std::uint64_t(y / down_) * at.lines_in_row + std::uint64_t(x / across_);
        const int within = y % down_ * across_ + x % across_;
        return base_ + at.begin + line * kLineBytes + std::uint64_t(within * texel_bytes_);
    }

private:
    struct Level {
        std::uint64_t begin, lines_in_row;
    };
    std::uint64_t base_, end_ = 0;
    int texel_bytes_, across_ = 1, down_ = 1;
    std::vector<Level> levels_;
};

class Study {
public:
    explicit Study(const json& job) : job_(job), width_(job.at("size").at(0)), height_(job.at("size").at(1)) {
        std::uint64_t base = 0;
        for (const json& texture : job.at("textures")) {
            layouts_.emplace_back(base, width_, height_, texture.at("bytes"));
            base += (layouts_.back().bytes() + 4095) / 4096 * 4096;
        }
        for (const Gpu& gpu : {kTitanXPascal, kH200}) replays_.emplace_back(gpu, int(layouts_.size()) * 8);
        per_pixel_ = job.at("records");
        rows_ =
            int((kBufferBytes / 4 - kHeadWords) / std::size_t(width_ * (per_pixel_ + 1))) / kBlock * kBlock;
        if (rows_ < kBlock) throw std::runtime_error("16 rows of records do not fit into 120 MiB");
    }

    json run() {
        const std::vector<std::filesystem::path> folders{job_.at("effects").get<std::string>()};
        EffectRegistry effects(folders);
        Diagnostics diagnostics;
        Pipeline pipeline;
        if (const auto node = parse_document(job_.at("look").dump(), "look", diagnostics))
            if (const auto look = parse_look(*node, diagnostics))
                pipeline = bind_pipeline(*look, effects, {}, diagnostics);
        if (diagnostics.has_errors()) {
            std::ostringstream faults;
            diagnostics.print(faults);
            throw std::runtime_error(faults.str());
        }
        gpu::Context context(gpu::test_backend());
        gpu::Buffer records(context, kBufferBytes, "records");
        PipelineRenderer renderer(context, pipeline, job_.at("data").get<std::string>());
        Capture capture = read_capture();
        const int settled = job_.at("settled");
        int frame = 0;
        const auto render = [&] {
            capture.header.frame = ++frame;
            FrameInputs inputs;
            inputs.capture = &capture;
            context.gl().BindBufferBase(GL_SHADER_STORAGE_BUFFER, kBinding, records.handle());
            renderer.render(inputs, {job_.at("role").get<std::string>()}, false);
        };
        for (int i = 0; i < settled; ++i) render();
        // One band a frame: all bands are of one state, but for the noise of its frames.
        for (int first = 0; first < height_; first += rows_) {
            const std::uint32_t head[kHeadWords] = {std::uint32_t(width_), std::uint32_t(first),
                                                    std::uint32_t(rows_), std::uint32_t(per_pixel_)};
            records.clear(0);
            records.write(std::as_bytes(std::span(head)));
            render();
            replay_band(records.read(), first);
        }
        for (GpuReplay& replay : replays_) replay.finish();
        return result();
    }

private:
    Capture read_capture() const {
        Sequence sequence;
        sequence.files = FramePattern(job_.at("capture").get<std::string>());
        sequence.profile = "native";
        Diagnostics diagnostics;
        const CaptureReader reader(
            sequence,
            read_profiles(std::filesystem::path(job_.at("data").get<std::string>()) / "profiles",
                          diagnostics),
            {});
        return reader.read(1, job_.at("roles").get<std::vector<std::string>>());
    }

    std::uint32_t word(const std::vector<std::byte>& bytes, std::size_t i) const {
        std::uint32_t value = 0;
        std::memcpy(&value, &bytes[4 * i], 4);
        return value;
    }

    void replay_band(const std::vector<std::byte>& bytes, int first) {
        const int end = std::min(first + rows_, height_);
        for (int y = first; y < end; y += kBlock)
            for (int x = 0; x < width_; x += kBlock) {
                std::vector<Warp> block;
                for (int wy = y; wy < std::min(y + kBlock, end); wy += kWarpHeight)
                    for (int wx = x; wx < std::min(x + kBlock, width_); wx += kWarpWidth)
                        block.push_back(warp_at(bytes, wx, wy, first, end));
                std::erase_if(block, [](const Warp& warp) { return warp.empty(); });
                if (block.empty()) continue;
                for (std::size_t i = 1; i < replays_.size(); ++i) replays_[i].add_block(block);
                replays_[0].add_block(std::move(block));
            }
    }

    /// The k-th fetch of each lane together; lanes of one texture and level are one instruction.
    Warp warp_at(const std::vector<std::byte>& bytes, int x0, int y0, int first, int end) {
        std::array<std::size_t, kLanes> at{};
        std::array<std::uint32_t, kLanes> counts{};
        int lanes = 0;
        std::uint32_t most = 0;
        for (int y = y0; y < std::min(y0 + kWarpHeight, end); ++y)
            for (int x = x0; x < std::min(x0 + kWarpWidth, width_); ++x, ++lanes) {
                const std::size_t place =
                    kHeadWords + std::size_t((y - first) * width_ + x) * std::size_t(per_pixel_ + 1);
                const std::uint32_t count = word(bytes, place);
                if (count > std::uint32_t(per_pixel_))
                    throw std::runtime_error("a pixel fetches more than 'records' texels");
                at[std::size_t(lanes)] = place + 1;
                counts[std::size_t(lanes)] = count;
                most = std::max(most, count);
                pixels_ += count > 0;
            }
        Warp warp;
        for (std::uint32_t k = 0; k < most; ++k) {
            std::map<int, Fetch> by_group;
            for (int lane = 0; lane < lanes; ++lane)
                if (k < counts[std::size_t(lane)])
                    add(by_group, unpack(word(bytes, at[std::size_t(lane)] + k)));
            for (auto& [group, fetch] : by_group) warp.push_back(fetch);
        }
        return warp;
    }

    /// A filtered fetch is one instruction for each of its four texels: a little more reads of L1 than of
    /// hardware, which joins those of a quad, and the same of L2.
    void add(std::map<int, Fetch>& by_group, const Record& record) const {
        const Layout& layout = layouts_.at(std::size_t(record.texture));
        const int group = record.texture * 8 + record.level;
        const auto put = [&](int x, int y, int more) {
            Fetch& fetch = by_group[group + 4096 * more];
            fetch.group = group;
            const int w = std::max(width_ >> record.level, 1), h = std::max(height_ >> record.level, 1);
            fetch.addresses[std::size_t(fetch.count++)] =
                layout.address(std::clamp(x, 0, w - 1), std::clamp(y, 0, h - 1), record.level);
        };
        if (!record.is_filtered) return put(record.x, record.y, 0);
        for (int i = 0; i < 4; ++i) put(record.x + (i & 1), record.y + (i >> 1), i);
    }

    json result() const {
        json gpus = json::array();
        for (std::size_t g = 0; g < replays_.size(); ++g) {
            json groups = json::array();
            for (std::size_t i = 0; i < replays_[g].counts().size(); ++i) {
                const Counts& c = replays_[g].counts()[i];
                if (c.texels)
                    groups.push_back({{"texture", job_.at("textures").at(i / 8).at("name")},
                                      {"level", i % 8},
                                      {"texels", c.texels},
                                      {"sectors", c.sectors},
                                      {"l1_hits", c.l1_hits},
                                      {"l2_reads", c.l2_reads()},
                                      {"l2_hits", c.l2_hits},
                                      {"dram_bytes", c.dram_sectors() * kSectorBytes}});
            }
            gpus.push_back({{"gpu", g == 0 ? kTitanXPascal.name : kH200.name}, {"groups", groups}});
        }
        return {{"pixels", pixels_}, {"gpus", gpus}};
    }

    json job_;
    int width_, height_, per_pixel_ = 0, rows_ = 0;
    std::vector<Layout> layouts_;
    std::vector<GpuReplay> replays_;
    std::uint64_t pixels_ = 0;
};

}  // namespace
}  // namespace aftershade::bench

int main() {
    try {
        std::cout << aftershade::bench::Study(nlohmann::json::parse(std::cin)).run();
        return 0;
    } catch (const std::exception& error) {
        std::cerr << "fetch_bench: " << error.what() << "\n";
        return 1;
    }
}
