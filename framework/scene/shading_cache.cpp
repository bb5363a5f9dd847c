#include "framework/scene/shading_cache.h"

#include <algorithm>
#include <array>
#include <iterator>
#include <list>
#include <unordered_map>
#include <utility>

#include "framework/base/names.h"
#include "framework/scene/shading_grid.h"

namespace aftershade::scene {

namespace {

constexpr Names<ShadingCache, 5> kCacheNames = {{{ShadingCache::global, "global"},
                                                 {ShadingCache::tile, "tile"},
                                                 {ShadingCache::sorted, "sorted"},
                                                 {ShadingCache::lru, "lru"},
                                                 {ShadingCache::fifo, "fifo"}}};

/// Bytes of an id and its shading's address.
constexpr std::uint64_t kEntryBytes = 8;

/// Calls visit(sample) for the samples of a tile that met something.
template <class Visit>
void for_each_sample_of_tile(const SampleIds& samples, int left, int top, int tile_px, const Visit& visit) {
    for (int y = top; y < std::min(top + tile_px, samples.height_px); ++y)
        for (int x = left; x < std::min(left + tile_px, samples.width_px); ++x) {
            const std::size_t pixel = std::size_t(y) * std::size_t(samples.width_px) + std::size_t(x);
            for (std::size_t i = samples.first_of(pixel); i < samples.first_of(pixel + 1); ++i)
                if (samples.ids[i] != kNoShading) visit(i);
        }
}

template <class Visit>
void for_each_tile(const SampleIds& samples, int tile_px, const Visit& visit) {
    for (int top = 0; top < samples.height_px; top += tile_px)
        for (int left = 0; left < samples.width_px; left += tile_px) visit(left, top);
}

/// `share_of(address)` is what each sample that used it has of a shading.
template <class ShareOf>
std::vector<float> sums_of_pixels(const SampleIds& addresses, const ShareOf& share_of) {
    std::vector<float> of_pixel(addresses.pixel_count());
    for (std::size_t pixel = 0; pixel < of_pixel.size(); ++pixel)
        for (const std::uint32_t address : addresses.of_pixel(pixel))
            if (address != kNoShading) of_pixel[pixel] += share_of(address);
    return of_pixel;
}

/// A cache has entry_of(id), an address that is kNoShading where the id is new; begin_tile(); and bytes().
template <class Cache>
CacheReplay replay_with(Cache cache, const SampleIds& samples, int tile_px) {
    Shadings shadings(samples);
    std::uint64_t bytes = 0;
    for_each_tile(samples, tile_px, [&](int left, int top) {
        cache.begin_tile();
        for_each_sample_of_tile(samples, left, top, tile_px, [&](std::size_t sample) {
            const std::uint32_t id = samples.ids[sample];
            std::uint32_t& address = cache.entry_of(id);
            if (address == kNoShading) address = shadings.add(id);
            shadings.use(address, sample);
        });
        bytes = std::max(bytes, cache.bytes());
    });
    return std::move(shadings).replay(bytes);
}

class InfiniteCache {
public:
    explicit InfiniteCache(bool is_of_tile) : is_of_tile_(is_of_tile) {}
    void begin_tile() {
        if (is_of_tile_) entries_.clear();
    }
    std::uint32_t& entry_of(std::uint32_t id) { return entries_.try_emplace(id, kNoShading).first->second; }
    std::uint64_t bytes() const { return entries_.size() * kEntryBytes; }

private:
    bool is_of_tile_;
    std::unordered_map<std::uint32_t, std::uint32_t> entries_;
};

/// Entries in the order of their use, or of their coming.
class FiniteCache {
public:
    FiniteCache(int entries, bool renews) : entries_(std::size_t(entries)), renews_(renews) {}
    void begin_tile() {}
    std::uint32_t& entry_of(std::uint32_t id) {
        const auto found = place_.find(id);
        if (found != place_.end()) {
            if (renews_) order_.splice(order_.end(), order_, found->second);
            return found->second->second;
        }
        if (order_.size() == entries_) {
            place_.erase(order_.front().first);
            order_.pop_front();
        }
        order_.emplace_back(id, kNoShading);
        place_[id] = std::prev(order_.end());
        return order_.back().second;
    }
    std::uint64_t bytes() const { return entries_ * kEntryBytes; }

private:
    using Order = std::list<std::pair<std::uint32_t, std::uint32_t>>;  // id, address
    std::size_t entries_;
    bool renews_;
    Order order_;
    std::unordered_map<std::uint32_t, Order::iterator> place_;
};

CacheReplay replay_sorted(const SampleIds& samples, int tile_px) {
    Shadings shadings(samples);
    std::uint64_t bytes = 0;
    std::vector<std::pair<std::uint32_t, std::size_t>> list;  // id, sample
    for_each_tile(samples, tile_px, [&](int left, int top) {
        list.clear();
        for_each_sample_of_tile(samples, left, top, tile_px,
                                [&](std::size_t sample) { list.emplace_back(samples.ids[sample], sample); });
        bytes = std::max(bytes, list.size() * kEntryBytes);
        std::sort(list.begin(), list.end());
        std::uint32_t address = 0;
        for (std::size_t i = 0; i < list.size(); ++i) {
            if (i == 0 || list[i].first != list[i - 1].first) address = shadings.add(list[i].first);
            shadings.use(address, list[i].second);
        }
    });
    return std::move(shadings).replay(bytes);
}

}  // namespace

std::optional<ShadingCache> parse_shading_cache(std::string_view name) {
    return value_named(kCacheNames, name);
}

std::vector<float> shadings_of_pixels(const SampleIds& addresses, std::span<const char> counts) {
    std::vector<std::uint32_t> uses(counts.size());
    for (const std::uint32_t address : addresses.ids)
        if (address != kNoShading) ++uses[address];
    return sums_of_pixels(addresses, [&](std::uint32_t address) {
        return counts[address] ? 1.0f / float(uses[address]) : 0.0f;
    });
}

Shadings::Shadings(const SampleIds& samples) : samples_(samples) {
    replay_.addresses.assign(samples.ids.size(), kNoShading);
}

std::uint32_t Shadings::add(std::uint32_t id) {
    uses_.push_back(0);
    replay_.ids.push_back(id);
    return std::uint32_t(uses_.size()) - 1;
}

void Shadings::use(std::uint32_t address, std::size_t sample) {
    ++uses_[address];
    replay_.addresses[sample] = address;
}

CacheReplay Shadings::replay(std::uint64_t cache_bytes) && {
    replay_.shadings = uses_.size();
    replay_.bytes = cache_bytes;
    for (const std::uint32_t uses : uses_) replay_.requests += uses;
    SampleIds addresses = samples_;
    addresses.ids = replay_.addresses;
    replay_.of_pixel =
        sums_of_pixels(addresses, [&](std::uint32_t address) { return 1.0f / float(uses_[address]); });
    return std::move(replay_);
}

CacheReplay replay(const SampleIds& samples, const ShadingCacheSettings& settings) {
    switch (settings.cache) {
        case ShadingCache::global: return replay_with(InfiniteCache(false), samples, settings.tile_px);
        case ShadingCache::tile: return replay_with(InfiniteCache(true), samples, settings.tile_px);
        case ShadingCache::sorted: return replay_sorted(samples, settings.tile_px);
        case ShadingCache::lru:
        case ShadingCache::fifo: break;
    }
    return replay_with(FiniteCache(settings.entries, settings.cache == ShadingCache::lru), samples,
                       settings.tile_px);
}

}  // namespace aftershade::scene
