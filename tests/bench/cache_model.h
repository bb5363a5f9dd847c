// Caches of a GPU, as far as texel fetches need them: which of the bytes that a draw fetches come from L1,
// from L2 and from DRAM. A model of counts, not of time.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace aftershade::bench {

inline constexpr std::uint64_t kLineBytes = 128, kSectorBytes = 32;

struct CacheSize {
    std::uint64_t bytes = 0;
    int ways = 0;
};

/// Least recently used, in sets; a line of 128 bytes is filled by sectors of 32, as NVIDIA's caches do since
/// Maxwell.
class Cache {
public:
    /// `size.bytes` is rounded down to a whole number of sets.
    explicit Cache(CacheSize size);

    /// Whether the sector at this address was there. It is afterwards.
    bool access(std::uint64_t address);

    std::uint64_t reads = 0, hits = 0;

private:
    struct Line {
        std::uint64_t tag = ~std::uint64_t(0);
        std::uint64_t used = 0;  ///< time of the last access
        unsigned sectors = 0;    ///< bit i: sector i is there
    };
    std::uint64_t sets_, clock_ = 0;
    std::size_t ways_;
    std::vector<Line> lines_;
};

struct Gpu {
    const char* name;
    int processors;  ///< streaming multiprocessors, each with its own L1
    CacheSize l1, l2;
    int warps_at_once;  ///< resident on one processor, in turns
};

/// NVIDIA TITAN X (Pascal): 28 SMs, 48 KiB of L1 each, 3 MiB of L2 (NVIDIA, GP102 data sheet, 2016).
inline constexpr Gpu kTitanXPascal = {"TITAN X Pascal", 28, {48 << 10, 6}, {3 << 20, 16}, 32};
/// NVIDIA H200: 132 SMs, 256 KiB of L1 and shared memory each, 50 MiB of L2 (NVIDIA, Hopper white paper,
/// 2022).
inline constexpr Gpu kH200 = {"H200", 132, {256 << 10, 8}, {50 << 20, 16}, 32};

inline constexpr int kLanes = 32;

/// The addresses that one warp fetches by one instruction; lanes that fetch nothing are left out.
struct Fetch {
    std::array<std::uint64_t, kLanes> addresses{};
    int count = 0;
    int group = 0;  ///< what it is counted as
};

/// What warps fetch, in the order of each one's instructions.
using Warp = std::vector<Fetch>;

struct Counts {
    std::uint64_t texels = 0;   ///< fetches of single lanes
    std::uint64_t sectors = 0;  ///< reads of L1: different sectors of each warp's instruction
    std::uint64_t l1_hits = 0;
    std::uint64_t l2_hits = 0;
    std::uint64_t l2_reads() const { return sectors - l1_hits; }
    std::uint64_t dram_sectors() const { return l2_reads() - l2_hits; }
};

/// Replays warps in blocks: each processor in turn takes the next block once it has room, and its resident
/// warps fetch in turns.
class GpuReplay {
public:
    GpuReplay(const Gpu& gpu, int groups);

    /// All warps of a block become resident together. A draw's blocks come in any number of calls.
    void add_block(std::vector<Warp> block);
    /// Runs what is still resident to its end.
    void finish();

    const std::vector<Counts>& counts() const { return counts_; }

private:
    struct Resident {
        Warp warp;
        std::size_t next = 0;
    };
    struct Processor {
        Cache l1;
        std::vector<Resident> warps;
    };
    bool step();  ///< one instruction of each resident warp; false where there is none
    void fetch(Processor& processor, const Fetch& fetch);

    Gpu gpu_;
    Cache l2_;
    std::vector<Processor> processors_;
    std::vector<Counts> counts_;
};

}  // namespace aftershade::bench
