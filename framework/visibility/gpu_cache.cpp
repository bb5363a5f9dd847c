#include "framework/visibility/gpu_cache.h"

#include <algorithm>
#include <array>
#include <bit>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "framework/scene/shading_grid.h"

namespace aftershade {
std::string_view visibility_cache_shader();   // cache.comp
std::string_view visibility_bucket_shader();  // bucket.comp
std::string_view visibility_fill_shader();    // fill.comp
}  // namespace aftershade

namespace aftershade::visibility {

using gpu::Access;
using scene::kNoShading;

namespace {

constexpr std::uint32_t kPlacesOfBucket = 4;  // as bucket.comp has it

struct CacheSettings {
    std::uint32_t width_px = 0;
    std::uint32_t pixel_count = 0;
    std::uint32_t sample_count = 0;
    std::uint32_t tile_px = 0;
    std::uint32_t slots = 0;
    std::uint32_t shading_count = 0;
    std::uint32_t order_px = 1;
    std::uint32_t unused = 0;
};

struct FillSettings {
    std::uint32_t word_count = 0;
    std::uint32_t value = 0;
    std::array<std::uint32_t, 2> unused{};
};

/// A power of two of at least twice `entries`, but no more than fit.
std::uint32_t slots_for(std::uint64_t entries, std::uint64_t tables, std::size_t max_bytes) {
    std::uint64_t slots = std::bit_ceil(2 * entries);
    while (slots > 1 && slots * tables * sizeof(std::uint32_t) > max_bytes) slots /= 2;
    return std::uint32_t(slots);
}

/// Of what a cache remembers: a binding of requests.glsl's shaders, its size and what it holds while empty.
struct Table {
    std::string name;
    int binding = 0;
    std::uint32_t words = 0;
    std::uint32_t empty = 0;
};

struct Cache {
    std::string name;
    std::string_view shader;
    CacheSettings settings;
    std::vector<Table> tables;
};

/// Passes that empty the tables, and one by which a band's samples ask for their ids.
class CacheGraph {
public:
    CacheGraph(Passes& passes, Cache cache, std::size_t pixels)
        : passes_(passes), cache_(std::move(cache)), executor_(executor_of(passes, make_graph(pixels))) {}

    void empty_tables() { passes_.run(executor_, {0, requests_}); }
    CacheCounts request(std::span<const std::uint32_t> ids, std::uint64_t earlier_shadings) {
        cache_.settings.shading_count = std::uint32_t(earlier_shadings);
        cache_.settings.pixel_count = std::uint32_t(ids.size()) / cache_.settings.sample_count;
        set(executor_, ids_, ids);
        executor_.set_uniforms(requests_, 0, bytes_of(cache_.settings));
        passes_.run(executor_, {requests_, requests_ + 1});
        const std::vector<std::uint32_t> found = values_of<std::uint32_t>(executor_, counts_);
        return {found[0], std::uint64_t(found[1]) + found[2], found[2]};
    }
    /// Of the samples that asked last.
    std::vector<std::uint32_t> places() { return values_of<std::uint32_t>(executor_, places_); }
    std::uint64_t bytes() const {
        std::uint64_t words = 0;
        for (const Table& table : cache_.tables) words += table.words;
        return words * sizeof(std::uint32_t);
    }

private:
    graph::FrameGraph make_graph(std::size_t pixels) {
        graph::FrameGraph graph;
        ids_ = graph.import_buffer("ids", {pixels * cache_.settings.sample_count * sizeof(std::uint32_t)});
        graph::Pass requests = passes_.pass("visibility." + cache_.name, cache_.shader, group_count(pixels));
        requests.uniforms = {{0, bytes_of(cache_.settings)}};
        requests.buffers = {{ids_, 0, Access::read}};
        for (const Table& table : cache_.tables) {
            graph::Pass fill = passes_.pass("visibility.empty_" + table.name, visibility_fill_shader(),
                                            std::min(group_count(table.words), kMaxGroups));
            fill.uniforms = {{0, bytes_of(FillSettings{table.words, table.empty, {}})}};
            fill.buffers = {
                {graph.create_buffer(table.name, {table.words * sizeof(std::uint32_t)}), 0, Access::write}};
            const graph::BufferHandle emptied = graph.add_pass(std::move(fill)).buffers.front();
            requests.buffers.push_back({emptied, table.binding, Access::read_write});
        }
        requests.buffers.push_back(
            {graph.create_buffer("places", {pixels * cache_.settings.sample_count * sizeof(std::uint32_t)}),
             4, Access::write});
        const std::size_t places = requests.buffers.size() - 1;
        const std::vector<std::uint32_t> zeros(3);
        requests.buffers.push_back(
            {graph.create_buffer("counts", {zeros.size() * sizeof(std::uint32_t)}, zeros), 2,
             Access::read_write});
        requests_ = graph.pass_count();
        const graph::Written written = graph.add_pass(std::move(requests));
        places_ = written.buffers[places];
        counts_ = written.buffers.back();
        graph.keep(places_);
        graph.keep(counts_);
        return graph;
    }

    Passes& passes_;
    Cache cache_;
    graph::BufferHandle ids_, places_, counts_;
    int requests_ = 0;
    graph::Executor executor_;  // made of all the above
};

/// Addresses of light by places of tables.
class Addresses {
public:
    explicit Addresses(const scene::SampleIds& samples) : samples_(samples), shadings_(samples) {}

    void forget_places() { of_place_.clear(); }
    /// Of the samples from `first` on. What another invocation has put into a place meanwhile is shaded
    /// again.
    void add(std::size_t first, std::size_t count, std::span<const std::uint32_t> places) {
        for (std::size_t i = 0; i < count; ++i)
            if (const std::uint32_t id = samples_.ids[first + i]; id != kNoShading)
                shadings_.use(address_of(id, places[i]), first + i);
    }
    scene::CacheReplay replay(std::uint64_t bytes) { return std::move(shadings_).replay(bytes); }

private:
    std::uint32_t address_of(std::uint32_t id, std::uint32_t place) {
        if (place == kNoShading) return shadings_.add(id);
        if (place >= of_place_.size()) of_place_.resize(std::size_t(place) + 1, kNoShading);
        std::uint32_t& address = of_place_[place];
        if (address == kNoShading) address = shadings_.add(id);
        return shadings_.id_of(address) == id ? address : shadings_.add(id);
    }

    const scene::SampleIds& samples_;
    scene::Shadings shadings_;
    std::vector<std::uint32_t> of_place_;
};

FilledCache fill_in_bands(Passes& passes, const scene::SampleIds& samples, Cache cache, const Bands& bands) {
    const auto width = std::size_t(samples.width_px), count = std::size_t(samples.samples);
    cache.settings.width_px = std::uint32_t(width);
    cache.settings.sample_count = std::uint32_t(count);
    FilledCache filled;
    CacheCounts& counts = filled.counts;
    Addresses addresses(samples);
    const bool has_tables_of_bands = cache.settings.tile_px > 0;
    CacheGraph graph(passes, std::move(cache), width * std::size_t(bands.rows));
    bands.for_each([&](int first, int rows) {
        if (first == 0 || has_tables_of_bands) {
            graph.empty_tables();
            addresses.forget_places();
        }
        const std::size_t first_sample = std::size_t(first) * width * count,
                          of_band = std::size_t(rows) * width * count;
        const CacheCounts own =
            graph.request(samples.ids.subspan(first_sample, of_band), counts.shadings - counts.overflows);
        addresses.add(first_sample, of_band, graph.places());
        counts.requests += own.requests;
        counts.shadings += own.shadings;
        counts.overflows += own.overflows;
    });
    filled.replay = addresses.replay(graph.bytes());
    return filled;
}

std::size_t bytes_of_row(const scene::SampleIds& samples) {
    return std::size_t(samples.width_px) * std::size_t(samples.samples) * sizeof(std::uint32_t);
}

}  // namespace

FilledCache fill_tables(Passes& passes, const scene::SampleIds& samples, std::uint32_t id_count, int tile_px,
                        std::size_t max_buffer_bytes) {
    const int step = std::max(tile_px, 1);
    const auto width = std::size_t(samples.width_px), side = std::size_t(step);
    Cache cache{"requests", visibility_cache_shader(), {}, {}};
    cache.settings.tile_px = std::uint32_t(tile_px);
    std::uint64_t tables = 1, ids = samples.ids.size();
    std::size_t table_of_row = 0;
    const std::uint64_t tiles_of_row = (width + side - 1) / side;
    if (tile_px > 0) {
        tables = tiles_of_row;
        ids = side * side * std::uint64_t(samples.samples);
    }
    cache.settings.slots = slots_for(std::min(ids, std::uint64_t(id_count)), tables, max_buffer_bytes);
    if (tile_px > 0) table_of_row = tiles_of_row * cache.settings.slots * sizeof(std::uint32_t) / side;
    const Bands bands(samples.width_px, samples.height_px, std::max(bytes_of_row(samples), table_of_row),
                      step, max_buffer_bytes);
    if (tile_px > 0) tables *= std::uint64_t((bands.rows + step - 1) / step);
    cache.tables = {{"table", 1, std::uint32_t(tables * cache.settings.slots), kNoShading}};
    return fill_in_bands(passes, samples, std::move(cache), bands);
}

FilledCache fill_buckets(Passes& passes, const scene::SampleIds& samples, int entries, int tile_px,
                         std::size_t max_buffer_bytes) {
    Cache cache{"bucket_requests", visibility_bucket_shader(), {}, {}};
    const std::uint32_t buckets =
        std::bit_ceil(std::uint32_t(entries + kPlacesOfBucket - 1) / kPlacesOfBucket);
    cache.settings.slots = buckets;
    cache.settings.order_px = std::uint32_t(tile_px);
    cache.tables = {{"keys", 1, buckets * kPlacesOfBucket, kNoShading},
                    {"buckets", 3, buckets * 2, 0},
                    {"addresses", 5, buckets * kPlacesOfBucket, kNoShading}};
    const Bands bands(samples.width_px, samples.height_px, bytes_of_row(samples), 1, max_buffer_bytes);
    return fill_in_bands(passes, samples, std::move(cache), bands);
}

}  // namespace aftershade::visibility
