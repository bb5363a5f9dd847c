// Addresses of light that GL's caches give to samples.
#include "framework/visibility/gpu_cache.h"

#include <algorithm>
#include <set>
#include <vector>

#include "framework/scene/samples.h"
#include "framework/scene/shading_grid.h"
#include "tests/gpu/gpu_test.h"

namespace aftershade::visibility {
namespace {

using scene::kNoShading;

class CacheOn : public gpu::SoftwareTest {};
ON_EACH_BACKEND(CacheOn);

constexpr int kCacheWidth_px = 96, kCacheHeight_px = 40, kCacheSamples = 8;
constexpr std::uint32_t kIds = 3000;

/// Neighbours share ids, as in pictures, and some samples meet nothing.
std::vector<std::uint32_t> sample_ids() {
    std::vector<std::uint32_t> ids;
    for (std::uint32_t i = 0; i < std::uint32_t(kCacheWidth_px * kCacheHeight_px * kCacheSamples); ++i) {
        const std::uint32_t noise = scene::pcg3d(i, 1, 2)[0];
        ids.push_back(noise % 7 == 0 ? kNoShading : (i / 23 + noise % 40) % kIds);
    }
    return ids;
}

/// Whether every sample fetches light of its own id, and all light is fetched.
void expect_own_light(const FilledCache& filled, const std::vector<std::uint32_t>& ids) {
    const scene::CacheReplay& replay = filled.replay;
    ASSERT_EQ(replay.addresses.size(), ids.size());
    std::vector<bool> is_used(replay.ids.size());
    std::uint64_t requests = 0;
    for (std::size_t i = 0; i < ids.size(); ++i) {
        const std::uint32_t address = replay.addresses[i];
        ASSERT_EQ(address == kNoShading, ids[i] == kNoShading) << i;
        if (address == kNoShading) continue;
        ++requests;
        ASSERT_LT(address, replay.ids.size());
        EXPECT_EQ(replay.ids[address], ids[i]) << i;
        is_used[address] = true;
    }
    EXPECT_TRUE(std::ranges::all_of(is_used, [](bool used) { return used; }));
    EXPECT_EQ(replay.requests, requests);
    EXPECT_EQ(filled.counts.requests, requests);
    EXPECT_EQ(replay.shadings, replay.ids.size());
    EXPECT_GE(replay.shadings, filled.counts.shadings) << "an address that goes while it is read is one more";
    float sum = 0;
    for (const float shadings : replay.of_pixel) sum += shadings;
    EXPECT_NEAR(sum, double(replay.shadings), 1e-3 * double(replay.shadings));
}

TEST_P(CacheOn, GivesSamplesTheAddressesOfTheirLight) {
    Passes passes(context());
    const std::vector<std::uint32_t> ids = sample_ids();
    const scene::SampleIds samples{ids, kCacheWidth_px, kCacheHeight_px, kCacheSamples};
    const std::size_t all = kMaxBufferBytes, bands = 60000;
    for (const std::size_t bytes : {all, bands}) {
        const FilledCache global = fill_tables(passes, samples, kIds, 0, bytes);
        expect_own_light(global, ids);
        EXPECT_EQ(global.replay.shadings, global.counts.shadings);
        EXPECT_EQ(std::set(global.replay.ids.begin(), global.replay.ids.end()).size(),
                  global.replay.ids.size());
        const FilledCache tiles = fill_tables(passes, samples, kIds, 8, bytes);
        expect_own_light(tiles, ids);
        EXPECT_EQ(tiles.replay.shadings, tiles.counts.shadings);
        EXPECT_EQ(tiles.replay.shadings, scene::replay(samples, {scene::ShadingCache::tile, 8}).shadings);
        for (const int entries : {1, 64, 4096})
            for (const int tile_px : {1, 16, 25})
                expect_own_light(fill_buckets(passes, samples, entries, tile_px, bytes), ids);
    }
}

TEST_P(CacheOn, GivesLightOfItsOwnToWhatFindsNoPlace) {
    Passes passes(context());
    const std::vector<std::uint32_t> ids = sample_ids();
    // The ids are said to be 64.
    const FilledCache full =
        fill_tables(passes, {ids, kCacheWidth_px, kCacheHeight_px, kCacheSamples}, 64, 0);
    EXPECT_GT(full.counts.overflows, 0u);
    expect_own_light(full, ids);
}

}  // namespace
}  // namespace aftershade::visibility
