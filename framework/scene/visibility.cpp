#include "framework/scene/visibility.h"

#include <algorithm>
#include <array>
#include <limits>
#include <utility>

#include "framework/core/parallel.h"

namespace aftershade::scene {

using glm::dvec3;

namespace {

constexpr std::array<std::pair<Visibility, std::string_view>, 3> kVisibilityNames = {
    {{Visibility::memoised, "memoised"},
     {Visibility::supersampled, "supersampled"},
     {Visibility::accumulation, "accumulation"}}};

constexpr std::uint64_t kShadingBytes = 12, kReferenceBytes = 8;

std::size_t pixel_count(const SceneRenderer& renderer) {
    return std::size_t(renderer.width_px()) * std::size_t(renderer.height_px());
}

/// The light of each id of the set, by its number in it.
std::vector<dvec3> shade_all(const SceneRenderer& renderer, const ShadingGrids& grids, const IdSet& set) {
    constexpr std::size_t kAtOnce = 256;
    const std::vector<std::uint32_t> ids = set.ids();
    std::vector<dvec3> light(ids.size());
    for_each_row(int((ids.size() + kAtOnce - 1) / kAtOnce), renderer.threads(), [&](int part) {
        const std::size_t first = std::size_t(part) * kAtOnce;
        for (std::size_t i = first; i < std::min(first + kAtOnce, ids.size()); ++i)
            light[i] = grids.shade(ids[i]);
    });
    return light;
}

Image resolve(const SceneRenderer& renderer, const std::vector<std::uint32_t>& ids, const IdSet& set,
              const std::vector<dvec3>& light, int samples) {
    Image color(renderer.width_px(), renderer.height_px(), 4);
    for_each_row(renderer.height_px(), renderer.threads(), [&](int y) {
        for (int x = 0; x < renderer.width_px(); ++x) {
            const std::size_t first =
                (std::size_t(y) * std::size_t(renderer.width_px()) + std::size_t(x)) * std::size_t(samples);
            dvec3 sum(0);
            for (std::size_t i = first; i < first + std::size_t(samples); ++i)
                sum += ids[i] == kNoShading ? renderer.scene().background : light[set.number_of(ids[i])];
            for (int c = 0; c < 3; ++c) color.at(x, y, c) = float(sum[c] / samples);
            color.at(x, y, 3) = 1;
        }
    });
    return color;
}

/// How many triangles the samples of each pixel met, summed.
std::uint64_t triangles_of_pixels(const SceneRenderer& renderer, const ShadingGrids& grids,
                                  const std::vector<std::uint32_t>& ids, int samples) {
    std::vector<std::uint64_t> of_row(std::size_t(renderer.height_px()));
    for_each_row(renderer.height_px(), renderer.threads(), [&](int y) {
        std::vector<std::uint32_t> met;
        for (int x = 0; x < renderer.width_px(); ++x) {
            const std::size_t first =
                (std::size_t(y) * std::size_t(renderer.width_px()) + std::size_t(x)) * std::size_t(samples);
            met.clear();
            for (std::size_t i = first; i < first + std::size_t(samples); ++i)
                if (ids[i] != kNoShading) met.push_back(grids.triangle_of(ids[i]));
            std::sort(met.begin(), met.end());
            of_row[std::size_t(y)] += std::uint64_t(std::unique(met.begin(), met.end()) - met.begin());
        }
    });
    std::uint64_t sum = 0;
    for (const std::uint64_t row : of_row) sum += row;
    return sum;
}

/// Rates and bytes out of the counts.
void complete(VisibilityReport& report, std::vector<float> of_pixel) {
    const double pixels = double(of_pixel.size());
    const double covered = double(report.requests) / report.samples;
    report.rate.of_pixels = double(report.shadings) / pixels;
    report.rate.of_covered_pixels = covered > 0 ? double(report.shadings) / covered : 0;
    report.rate.multisampled = covered > 0 ? report.rate.multisampled / covered : 0;
    const auto p95 = of_pixel.begin() + std::ptrdiff_t(0.95 * (pixels - 1));
    std::nth_element(of_pixel.begin(), p95, of_pixel.end());
    report.rate.p95 = *p95;
    const std::uint64_t samples = std::uint64_t(of_pixel.size()) * std::uint64_t(report.samples);
    report.bytes.supersampled = samples * kShadingBytes;
}

Image rate_image(const SceneRenderer& renderer, const std::vector<float>& of_pixel) {
    Image image(renderer.width_px(), renderer.height_px(), 1);
    std::copy(of_pixel.begin(), of_pixel.end(), image.floats().begin());
    return image;
}

VisibilityPicture render_memoised(const SceneRenderer& renderer, const ShadingGrids& grids, int frame,
                                  const VisibilitySettings& settings, const std::vector<std::uint32_t>& ids) {
    const CacheCounts counts =
        replay({ids, renderer.width_px(), renderer.height_px(), settings.samples}, settings.cache);
    const IdSet set(ids, grids.id_count());
    VisibilityPicture picture;
    picture.color = resolve(renderer, ids, set, shade_all(renderer, grids, set), settings.samples);
    picture.shading_rate = rate_image(renderer, counts.of_pixel);
    VisibilityReport& report = picture.report;
    report = {.frame = frame,
              .samples = settings.samples,
              .requests = counts.requests,
              .shadings = counts.shadings,
              .rate = {},
              .bytes = {ids.size() * kReferenceBytes, counts.shadings * kShadingBytes, counts.bytes, 0}};
    report.rate.multisampled = double(triangles_of_pixels(renderer, grids, ids, settings.samples));
    complete(report, counts.of_pixel);
    return picture;
}

/// Light at every sample.
VisibilityPicture render_plain(const SceneRenderer& renderer, int frame, const VisibilitySettings& settings) {
    std::vector<dvec3> sums(pixel_count(renderer), dvec3(0));
    std::vector<float> of_pixel(sums.size());
    renderer.for_each_sample(
        frame, truth_of(settings), [&](int x, int y, int, const World& world, const Ray& ray) {
            const std::size_t pixel = std::size_t(y) * std::size_t(renderer.width_px()) + std::size_t(x);
            const auto surface = world.trace(ray, 0, std::numeric_limits<double>::infinity());
            sums[pixel] += surface ? world.shade(*surface, ray.origin).color() : renderer.scene().background;
            of_pixel[pixel] += surface ? 1.0f : 0.0f;
        });
    VisibilityPicture picture;
    picture.color = Image(renderer.width_px(), renderer.height_px(), 4);
    for (std::size_t i = 0; i < sums.size(); ++i) {
        for (std::size_t c = 0; c < 3; ++c)
            picture.color.floats()[i * 4 + c] = float(sums[i][int(c)] / settings.samples);
        picture.color.floats()[i * 4 + 3] = 1;
    }
    picture.shading_rate = rate_image(renderer, of_pixel);
    VisibilityReport& report = picture.report;
    report.frame = frame;
    report.samples = settings.samples;
    for (const float shadings : of_pixel) report.requests += std::uint64_t(shadings);
    report.shadings = report.requests;
    complete(report, std::move(of_pixel));
    report.bytes.shading = report.bytes.supersampled;
    return picture;
}

}  // namespace

std::optional<Visibility> parse_visibility(std::string_view name) {
    for (const auto& [visibility, own_name] : kVisibilityNames)
        if (own_name == name) return visibility;
    return std::nullopt;
}

std::string_view visibility_name(Visibility visibility) {
    return std::find_if(kVisibilityNames.begin(), kVisibilityNames.end(),
                        [&](const auto& entry) { return entry.first == visibility; })
        ->second;
}

std::vector<std::uint32_t> trace_ids(const SceneRenderer& renderer, const ShadingGrids& grids, int frame,
                                     const VisibilitySettings& settings) {
    std::vector<std::uint32_t> ids(pixel_count(renderer) * std::size_t(settings.samples), kNoShading);
    renderer.for_each_sample(
        frame, truth_of(settings), [&](int x, int y, int sample, const World& world, const Ray& ray) {
            const auto surface = world.trace(ray, 0, std::numeric_limits<double>::infinity());
            if (!surface) return;
            const std::size_t pixel = std::size_t(y) * std::size_t(renderer.width_px()) + std::size_t(x);
            ids[pixel * std::size_t(settings.samples) + std::size_t(sample)] = grids.id_of(*surface);
        });
    return ids;
}

TruthSettings truth_of(const VisibilitySettings& settings) {
    TruthSettings truth;
    truth.kinds = {.lens = true, .shutter = true, .antialias = true};
    truth.method = settings.visibility == Visibility::accumulation ? TruthMethod::accumulation
                                                                   : TruthMethod::interleaved;
    truth.samples = settings.samples;
    truth.seed = settings.seed;
    truth.jitter_px = settings.jitter_px;
    return truth;
}

VisibilityPicture render_visibility(const SceneRenderer& renderer, int frame,
                                    const VisibilitySettings& settings, const IdTracer& tracer) {
    if (settings.visibility != Visibility::memoised) return render_plain(renderer, frame, settings);
    const ShadingGrids grids(renderer, frame, settings.grid);
    return render_memoised(renderer, grids, frame, settings, tracer(renderer, grids, frame, settings));
}

}  // namespace aftershade::scene
