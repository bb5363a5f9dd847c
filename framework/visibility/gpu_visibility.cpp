#include "framework/visibility/gpu_visibility.h"

#include <array>
#include <bit>
#include <cstring>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "framework/core/parallel.h"
#include "framework/gpu/buffer.h"
#include "framework/gpu/commands.h"
#include "framework/gpu/program.h"
#include "framework/visibility/bands.h"
#include "framework/visibility/gpu_scene.h"

namespace aftershade {
std::string_view visibility_trace_shader();   // trace.comp
std::string_view visibility_cache_shader();   // cache.comp
std::string_view visibility_bucket_shader();  // bucket.comp
}  // namespace aftershade

namespace aftershade::visibility {

using glm::vec4;
using gpu::Buffer;
using scene::kNoShading;

namespace {

constexpr std::uint32_t kPlacesOfBucket = 4;  // as bucket.comp has it

struct GpuRay {
    vec4 origin{0};
    vec4 direction{0};
    vec4 stops{0};
};

struct TraceSettings {
    glm::vec2 size_px{0};
    float px_per_tangent = 0;
    std::uint32_t node_count = 0;
    std::uint32_t object_count = 0;
    std::uint32_t pixel_count = 0;
    std::uint32_t sample_index = 0;
    std::uint32_t sample_count = 0;
    std::uint32_t transparent = 0;
    std::array<std::uint32_t, 3> unused{};
};

struct CacheSettings {
    std::uint32_t width_px = 0;
    std::uint32_t pixel_count = 0;
    std::uint32_t sample_count = 0;
    std::uint32_t tile_px = 0;
    std::uint32_t slots = 0;
    std::array<std::uint32_t, 3> unused{};
};

template <class T>
Buffer filled(gpu::Context& context, const std::vector<T>& values, std::string label) {
    Buffer buffer(context, std::max(values.size(), std::size_t(1)) * sizeof(T), std::move(label));
    buffer.write(bytes_of(values));
    return buffer;
}

template <class T>
std::vector<T> values_of(const Buffer& buffer) {
    const std::vector<std::byte> bytes = buffer.read();
    std::vector<T> values(bytes.size() / sizeof(T));
    std::memcpy(values.data(), bytes.data(), values.size() * sizeof(T));
    return values;
}

/// Where the sample stops at transparent surfaces, and the seed for what it crosses after four of them.
void set_stops(GpuRay& ray, const scene::VisibilitySettings& settings, int frame, int x, int y, int sample) {
    const std::uint32_t seed = scene::StopNumbers::pixel_seed(settings.seed, frame, x, y);
    const scene::StopNumbers stops(seed, sample, settings.samples);
    const std::array<double, 4>& first = stops.first();
    ray.stops = vec4(first[0], first[1], first[2], first[3]);
    ray.direction.w = std::bit_cast<float>(seed);
}

std::vector<GpuRay> rays_of_band(const scene::SceneRenderer& renderer, int frame,
                                 const scene::VisibilitySettings& settings, int sample,
                                 const std::vector<scene::World>& moments, int first_row, int rows) {
    const scene::TruthSettings truth = truth_of(settings);
    const bool transparent = renderer.scene().has_transparency();
    std::vector<GpuRay> rays(std::size_t(renderer.width_px()) * std::size_t(rows));
    for_each_row(rows, renderer.threads(), [&](int row) {
        for (int x = 0; x < renderer.width_px(); ++x) {
            const auto own = renderer.sample_of(frame, truth, sample, x, first_row + row, moments);
            GpuRay& ray = rays[std::size_t(row) * std::size_t(renderer.width_px()) + std::size_t(x)];
            ray.origin = vec4(glm::vec3(own.ray.origin), std::bit_cast<float>(std::uint32_t(own.moment)));
            ray.direction = vec4(glm::vec3(own.ray.direction), 0);
            if (transparent) set_stops(ray, settings, frame, x, first_row + row, sample);
        }
    });
    return rays;
}

/// A power of two of at least twice `entries`, but no more than fit.
std::uint32_t slots_for(std::uint64_t entries, std::uint64_t tables, std::size_t max_bytes) {
    std::uint64_t slots = std::bit_ceil(2 * entries);
    while (slots > 1 && slots * tables * sizeof(std::uint32_t) > max_bytes) slots /= 2;
    return std::uint32_t(slots);
}

/// Runs a cache over the samples, band by band. `tables_of(rows)` gives the buffers beside ids and counts.
template <class Tables>
CacheCounts count_in_bands(gpu::Context& context, std::string_view shader, const scene::SampleIds& samples,
                           CacheSettings values, std::size_t table_of_row, int step,
                           std::size_t max_buffer_bytes, const Tables& tables_of) {
    const auto width = std::size_t(samples.width_px), count = std::size_t(samples.samples);
    const gpu::Program program = gpu::Program::compute(context, std::string(shader), "shading cache");
    values.width_px = std::uint32_t(width);
    values.sample_count = std::uint32_t(count);
    Buffer uniforms(context, sizeof values, "settings"), counts(context, 3 * sizeof(std::uint32_t), "counts");
    const auto count_band = [&](int first, int rows) {
        const std::size_t pixels = width * std::size_t(rows);
        const std::span<const std::uint32_t> of_band =
            samples.ids.subspan(std::size_t(first) * width * count, pixels * count);
        const Buffer ids = filled(context, std::vector(of_band.begin(), of_band.end()), "ids");
        std::vector<gpu::BufferBinding> storage = tables_of(rows);
        storage.push_back({&ids, 0});
        storage.push_back({&counts, 2});
        values.pixel_count = std::uint32_t(pixels);
        uniforms.write(bytes_of(std::array{values}));
        const gpu::BufferBinding block[] = {{&uniforms, 0}};
        gpu::dispatch(context, program, group_count(pixels), 1, 1, {.uniforms = block, .storage = storage});
    };
    for_each_band(samples.width_px, samples.height_px,
                  std::max(width * count * sizeof(std::uint32_t), table_of_row), step, max_buffer_bytes,
                  count_band);
    const std::vector<std::uint32_t> found = values_of<std::uint32_t>(counts);
    return {found[0], std::uint64_t(found[1]) + found[2], found[2]};
}

}  // namespace

std::vector<std::uint32_t> trace_ids(gpu::Context& context, const scene::SceneRenderer& renderer,
                                     const scene::ShadingGrids& grids, int frame,
                                     const scene::VisibilitySettings& settings,
                                     std::size_t max_buffer_bytes) {
    const auto width = std::size_t(renderer.width_px()), samples = std::size_t(settings.samples);
    const scene::TruthSettings truth = truth_of(settings);
    const GpuScene scene = make_gpu_scene(renderer, grids, frame);
    const gpu::Program program =
        gpu::Program::compute(context, std::string(visibility_trace_shader()), "visibility");
    const Buffer nodes = filled(context, scene.nodes, "nodes"),
                 triangles = filled(context, scene.triangles, "triangles");
    TraceSettings values;
    values.size_px = {renderer.width_px(), renderer.height_px()};
    values.px_per_tangent = float(renderer.pixels_per_tangent(grids.reference().camera));
    values.node_count = std::uint32_t(scene.nodes.size());
    values.object_count = std::uint32_t(renderer.scene().objects.size());
    values.sample_count = std::uint32_t(settings.samples);
    values.transparent = renderer.scene().has_transparency() ? 1 : 0;
    Buffer uniforms(context, sizeof values, "settings");
    std::vector<std::uint32_t> ids;
    const std::size_t bytes_of_row = width * std::max(samples * sizeof(std::uint32_t), sizeof(GpuRay));
    const auto trace_band = [&](int first, int rows) {
        const std::size_t pixels = width * std::size_t(rows);
        const Buffer found(context, pixels * samples * sizeof(std::uint32_t), "ids");
        for (int sample = 0; sample < settings.samples; ++sample) {
            const std::vector<scene::World> worlds = renderer.moments_of(frame, truth, sample);
            const Buffer moments = filled(context, make_moments(worlds), "moments");
            const Buffer rays =
                filled(context, rays_of_band(renderer, frame, settings, sample, worlds, first, rows), "rays");
            values.pixel_count = std::uint32_t(pixels);
            values.sample_index = std::uint32_t(sample);
            uniforms.write(bytes_of(std::array{values}));
            const gpu::BufferBinding block[] = {{&uniforms, 0}};
            const gpu::BufferBinding storage[] = {
                {&nodes, 0}, {&triangles, 1}, {&moments, 2}, {&rays, 3}, {&found, 4}};
            gpu::dispatch(context, program, group_count(pixels), 1, 1,
                          {.uniforms = block, .storage = storage});
        }
        const std::vector<std::uint32_t> band = values_of<std::uint32_t>(found);
        ids.insert(ids.end(), band.begin(), band.end());
    };
    for_each_band(renderer.width_px(), renderer.height_px(), bytes_of_row, 1, max_buffer_bytes, trace_band);
    return ids;
}

CacheCounts count_shadings(gpu::Context& context, const scene::SampleIds& samples, std::uint32_t id_count,
                           int tile_px, std::size_t max_buffer_bytes) {
    const auto width = std::size_t(samples.width_px), count = std::size_t(samples.samples);
    const int step = std::max(tile_px, 1);
    const std::uint64_t of_tile =
        std::min(std::uint64_t(step) * std::uint64_t(step) * count, std::uint64_t(id_count));
    const std::uint64_t tiles_of_row = (width + std::size_t(step) - 1) / std::size_t(step);
    CacheSettings values;
    values.tile_px = std::uint32_t(tile_px);
    values.slots = tile_px > 0
                       ? slots_for(of_tile, tiles_of_row, max_buffer_bytes)
                       : slots_for(std::min(std::uint64_t(samples.ids.size()), std::uint64_t(id_count)), 1,
                                   max_buffer_bytes);
    const std::size_t table_of_row =
        tile_px > 0 ? tiles_of_row * values.slots * sizeof(std::uint32_t) / std::size_t(step) : 0;
    std::optional<Buffer> table;
    const auto tables_of = [&](int rows) {
        const std::uint64_t tables = tile_px > 0 ? tiles_of_row * std::uint64_t((rows + step - 1) / step) : 1;
        if (tile_px > 0 || !table) {
            table.emplace(context, std::size_t(tables * values.slots * sizeof(std::uint32_t)), "table");
            table->clear(kNoShading);
        }
        return std::vector<gpu::BufferBinding>{{&*table, 1}};
    };
    return count_in_bands(context, visibility_cache_shader(), samples, values, table_of_row, step,
                          max_buffer_bytes, tables_of);
}

CacheCounts count_shadings_in_buckets(gpu::Context& context, const scene::SampleIds& samples, int entries,
                                      std::size_t max_buffer_bytes) {
    CacheSettings values;
    values.slots = std::bit_ceil(std::uint32_t(entries + kPlacesOfBucket - 1) / kPlacesOfBucket);
    Buffer keys(context, values.slots * kPlacesOfBucket * sizeof(std::uint32_t), "keys"),
        buckets(context, values.slots * 2 * sizeof(std::uint32_t), "buckets");
    keys.clear(kNoShading);
    const auto tables_of = [&](int) { return std::vector<gpu::BufferBinding>{{&keys, 1}, {&buckets, 3}}; };
    return count_in_bands(context, visibility_bucket_shader(), samples, values, 0, 1, max_buffer_bytes,
                          tables_of);
}

}  // namespace aftershade::visibility
