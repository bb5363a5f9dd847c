#include "tests/bench/cache_model.h"

#include <algorithm>
#include <utility>

namespace aftershade::bench {

Cache::Cache(CacheSize size)
    : sets_(std::max<std::uint64_t>(size.bytes / (kLineBytes * std::uint64_t(size.ways)), 1)),
      ways_(std::size_t(size.ways)),
      lines_(sets_ * ways_) {}

bool Cache::access(std::uint64_t address) {
    const std::uint64_t line = address / kLineBytes;
    const unsigned sector = 1U << (address % kLineBytes / kSectorBytes);
    Line* const set = &lines_[(line % sets_) * ways_];
    Line* oldest = set;
    ++reads;
    ++clock_;
    for (Line* way = set; way != set + ways_; ++way) {
        if (way->tag == line) {
            const bool is_there = way->sectors & sector;
            way->sectors |= sector;
            way->used = clock_;
            hits += is_there;
            return is_there;
        }
        if (way->used < oldest->used) oldest = way;
    }
    *oldest = {line, clock_, sector};
    return false;
}

GpuReplay::GpuReplay(const Gpu& gpu, int groups)
    : gpu_(gpu),
      l2_(gpu.l2),
      processors_(std::size_t(gpu.processors), Processor{Cache(gpu.l1), {}}),
      counts_(std::size_t(groups)) {}

void GpuReplay::add_block(std::vector<Warp> block) {
    const auto emptiest = [&] {
        return std::min_element(
            processors_.begin(), processors_.end(),
            [](const Processor& a, const Processor& b) { return a.warps.size() < b.warps.size(); });
    };
    while (emptiest()->warps.size() + block.size() > std::size_t(gpu_.warps_at_once) && step()) {
    }
    Processor& processor = *emptiest();
    for (Warp& warp : block)
        if (!warp.empty()) processor.warps.push_back({std::move(warp)});
}

void GpuReplay::finish() {
    while (step()) {
    }
}

bool GpuReplay::step() {
    bool any = false;
    for (Processor& processor : processors_) {
        for (Resident& resident : processor.warps) fetch(processor, resident.warp[resident.next++]);
        any = any || !processor.warps.empty();
        std::erase_if(processor.warps, [](const Resident& r) { return r.next == r.warp.size(); });
    }
    return any;
}

void GpuReplay::fetch(Processor& processor, const Fetch& fetch) {
    std::array<std::uint64_t, kLanes> sectors{};
    for (int i = 0; i < fetch.count; ++i)
        sectors[std::size_t(i)] = fetch.addresses[std::size_t(i)] / kSectorBytes;
    std::sort(sectors.begin(), sectors.begin() + fetch.count);
    const auto end = std::unique(sectors.begin(), sectors.begin() + fetch.count);
    Counts& counts = counts_[std::size_t(fetch.group)];
    counts.texels += std::uint64_t(fetch.count);
    for (auto sector = sectors.begin(); sector != end; ++sector) {
        ++counts.sectors;
        if (processor.l1.access(*sector * kSectorBytes)) ++counts.l1_hits;
        else if (l2_.access(*sector * kSectorBytes)) ++counts.l2_hits;
    }
}

}  // namespace aftershade::bench
