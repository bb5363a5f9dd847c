#include "framework/scene/visibility.h"

#include <algorithm>
#include <array>
#include <bit>
#include <limits>
#include <numeric>
#include <span>
#include <utility>

#include "framework/base/names.h"
#include "framework/base/parallel.h"
#include "framework/scene/samples.h"

namespace aftershade::scene {

using glm::dvec3;

namespace {

constexpr Names<Visibility, 3> kVisibilityNames = {{{Visibility::memoised, "memoised"},
                                                    {Visibility::supersampled, "supersampled"},
                                                    {Visibility::accumulation, "accumulation"}}};

constexpr std::uint64_t kShadingBytes = 12, kReferenceBytes = 8;

std::size_t pixel_of(const SceneRenderer& renderer, int x, int y) {
    return std::size_t(y) * std::size_t(renderer.width_px()) + std::size_t(x);
}

std::size_t pixel_count(const SceneRenderer& renderer) {
    return pixel_of(renderer, 0, renderer.height_px());
}

template <class Visit>
void for_each_pixel(const SceneRenderer& renderer, const Visit& visit) {
    for_each_row(renderer.height_px(), renderer.threads(), [&](int y) {
        for (int x = 0; x < renderer.width_px(); ++x) visit(x, y);
    });
}

/// The one surface that a sample shows.
std::optional<Surface> trace_sample(const World& world, const Ray& ray, const VisibilitySettings& settings,
                                    int frame, int x, int y, int sample) {
    if (!world.scene().has_transparency())
        return world.trace(ray, 0, std::numeric_limits<double>::infinity());
    const std::uint32_t seed = StopNumbers::pixel_seed(settings.seed, frame, x, y);
    return trace_stochastic(world, ray, StopNumbers(seed, sample, settings.samples));
}

/// The light of each address.
std::vector<dvec3> shade_all(const SceneRenderer& renderer, const ShadingGrids& grids,
                             std::span<const std::uint32_t> ids) {
    std::vector<dvec3> light(ids.size());
    for_each_index(ids.size(), renderer.threads(), [&](std::size_t i) { light[i] = grids.shade(ids[i]); });
    return light;
}

/// What the samples of a picture ended at, and what they crossed before that.
struct Traced {
    std::vector<std::uint32_t> ends;  ///< as SampleIds has them
    std::optional<TransparentLists> lists;
};

/// The mean over `count` samples, whose ends come after the list, by sample and the nearest first.
template <class LightOf>
dvec3 blended(std::span<const std::uint32_t> addresses, std::span<const ListNode> list, int count,
              const LightOf& light_of) {
    dvec3 sum(0);
    std::size_t at = 0;
    for (int sample = 0; sample < count; ++sample) {
        double through = 1;
        for (; at < list.size() && int(list[at].sample) == sample; ++at) {
            const double opacity = double(list[at].opacity);
            sum += through * opacity * light_of(addresses[at]);
            through *= 1 - opacity;
        }
        sum += through * light_of(addresses[list.size() + std::size_t(sample)]);
    }
    return sum / double(count);
}

/// `addresses` are those of what samples crossed, if there are lists, and of what they ended at.
Image blend(const SceneRenderer& renderer, std::span<const dvec3> light, const SampleIds& addresses,
            const TransparentLists* lists) {
    Image color(renderer.width_px(), renderer.height_px(), 4);
    const auto light_of = [&](std::uint32_t address) {
        return address == kNoShading ? renderer.scene().background : light[address];
    };
    for_each_pixel(renderer, [&](int x, int y) {
        const std::vector<ListNode> list = lists ? lists->sorted(x, y) : std::vector<ListNode>();
        const dvec3 mean =
            blended(addresses.of_pixel(pixel_of(renderer, x, y)), list, addresses.samples, light_of);
        for (int c = 0; c < 3; ++c) color.at(x, y, c) = float(mean[c]);
        color.at(x, y, 3) = 1;
    });
    return color;
}

/// How many triangles the samples of each pixel met, summed.
std::uint64_t triangles_of_pixels(const SceneRenderer& renderer, const ShadingGrids& grids,
                                  const SampleIds& samples) {
    std::vector<std::uint64_t> of_row(std::size_t(renderer.height_px()));
    for_each_row(renderer.height_px(), renderer.threads(), [&](int y) {
        std::vector<std::uint32_t> met;
        for (int x = 0; x < renderer.width_px(); ++x) {
            met.clear();
            for (const std::uint32_t id : samples.of_pixel(pixel_of(renderer, x, y)))
                if (id != kNoShading) met.push_back(grids.triangle_of(id));
            std::sort(met.begin(), met.end());
            of_row[std::size_t(y)] += std::uint64_t(std::unique(met.begin(), met.end()) - met.begin());
        }
    });
    return std::reduce(of_row.begin(), of_row.end(), std::uint64_t(0));
}

/// What lists hold and what samples ended at, together.
struct AllIds {
    std::vector<std::uint32_t> ids;
    std::vector<std::size_t> first;
};

AllIds all_ids_of(const SceneRenderer& renderer, const Traced& traced, int samples) {
    AllIds all;
    for (int y = 0; y < renderer.height_px(); ++y)
        for (int x = 0; x < renderer.width_px(); ++x) {
            all.first.push_back(all.ids.size());
            for (const ListNode& node : traced.lists->sorted(x, y)) all.ids.push_back(node.id);
            const auto end =
                traced.ends.begin() + std::ptrdiff_t(pixel_of(renderer, x, y) * std::size_t(samples));
            all.ids.insert(all.ids.end(), end, end + samples);
        }
    all.first.push_back(all.ids.size());
    return all;
}

/// Samples that met a surface.
std::uint64_t met_samples(const SceneRenderer& renderer, const Traced& traced, int samples) {
    if (!traced.lists)
        return std::uint64_t(std::count_if(traced.ends.begin(), traced.ends.end(),
                                           [](std::uint32_t id) { return id != kNoShading; }));
    std::vector<std::uint64_t> of_row(std::size_t(renderer.height_px()));
    for_each_pixel(renderer, [&](int x, int y) {
        const std::size_t first = pixel_of(renderer, x, y) * std::size_t(samples);
        std::uint64_t met = 0;
        for (int i = 0; i < samples; ++i)
            if (traced.ends[first + std::size_t(i)] != kNoShading) met |= std::uint64_t(1) << i;
        for (const ListNode& node : traced.lists->sorted(x, y)) met |= std::uint64_t(1) << node.sample;
        of_row[std::size_t(y)] += std::uint64_t(std::popcount(met));
    });
    return std::reduce(of_row.begin(), of_row.end(), std::uint64_t(0));
}

/// Rates and bytes out of the counts.
void complete(VisibilityReport& report, std::vector<float> of_pixel, std::uint64_t met) {
    const double pixels = double(of_pixel.size());
    const double covered = double(met) / report.samples;
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
                                  const VisibilitySettings& settings, const Traced& traced,
                                  const VisibilityPasses& passes, KeptShadings* kept) {
    SampleIds samples{traced.ends, renderer.width_px(), renderer.height_px(), settings.samples};
    AllIds all;
    if (traced.lists) {
        all = all_ids_of(renderer, traced, settings.samples);
        samples.ids = all.ids;
        samples.first = all.first;
    }
    CacheReplay replayed =
        traced.lists || kept ? replay(samples, settings.cache) : passes.fill(samples, grids, settings.cache);
    SampleIds addresses = samples;
    addresses.ids = replayed.addresses;
    const TransparentLists* lists = traced.lists ? &*traced.lists : nullptr;
    VisibilityPicture picture;
    VisibilityReport& report = picture.report;
    if (kept) {
        const KeptShadings::Lit lit = kept->light(renderer, grids, replayed.ids);
        picture.color = blend(renderer, lit.light, addresses, lists);
        replayed.of_pixel = shadings_of_pixels(addresses, lit.is_new);
        report.kept = std::uint64_t(std::ranges::count(lit.is_new, 0));
        report.highlights = lit.highlight_count;
        report.bytes.kept = kept->bytes();
    } else {
        picture.color = lists ? blend(renderer, shade_all(renderer, grids, replayed.ids), addresses, lists)
                              : passes.resolve(renderer, grids, replayed.ids, addresses);
    }
    picture.shading_rate = rate_image(renderer, replayed.of_pixel);
    report.frame = frame;
    report.samples = settings.samples;
    report.requests = replayed.requests;
    report.shadings = replayed.shadings - report.kept;
    report.bytes.visibility = traced.ends.size() * kReferenceBytes;
    report.bytes.shading = replayed.shadings * kShadingBytes;
    report.bytes.cache = replayed.bytes;
    if (lists) {
        report.list_nodes = lists->node_count();
        report.list_overflows = lists->overflows();
        report.bytes.lists = lists->bytes();
    }
    report.rate.multisampled = double(triangles_of_pixels(renderer, grids, samples));
    complete(report, replayed.of_pixel, met_samples(renderer, traced, settings.samples));
    return picture;
}

VisibilityPicture render_plain(const SceneRenderer& renderer, int frame, const VisibilitySettings& settings,
                               const SampleLighter& light) {
    const LitSamples lit = light(renderer, frame, settings);
    VisibilityPicture picture;
    picture.color = Image(renderer.width_px(), renderer.height_px(), 4);
    for (std::size_t i = 0; i < lit.sums.size(); ++i) {
        for (std::size_t c = 0; c < 3; ++c)
            picture.color.floats()[i * 4 + c] = float(lit.sums[i][int(c)] / settings.samples);
        picture.color.floats()[i * 4 + 3] = 1;
    }
    std::vector<float> of_pixel(lit.shadings.begin(), lit.shadings.end());
    picture.shading_rate = rate_image(renderer, of_pixel);
    VisibilityReport& report = picture.report;
    report.frame = frame;
    report.samples = settings.samples;
    report.requests = report.shadings =
        std::reduce(lit.shadings.begin(), lit.shadings.end(), std::uint64_t(0));
    complete(report, std::move(of_pixel), std::reduce(lit.met.begin(), lit.met.end(), std::uint64_t(0)));
    report.bytes.shading = report.bytes.supersampled;
    return picture;
}

/// What does not fit into the lists stops samples by chance, as all does without them.
Traced trace_lists(const SceneRenderer& renderer, const ShadingGrids& grids, int frame,
                   const VisibilitySettings& settings) {
    Traced traced{
        std::vector(pixel_count(renderer) * std::size_t(settings.samples), kNoShading),
        TransparentLists(renderer.width_px(), renderer.height_px(), settings.transparency.list_nodes)};
    renderer.for_each_sample(
        frame, truth_of(settings), [&](int x, int y, int sample, const World& world, const Ray& ray) {
            const std::uint32_t seed = StopNumbers::pixel_seed(settings.seed, frame, x, y);
            const StopNumbers stops(seed, sample, settings.samples);
            std::uint32_t& end =
                traced.ends[pixel_of(renderer, x, y) * std::size_t(settings.samples) + std::size_t(sample)];
            int crossing = 0;
            world.cross(ray, [&](const Surface& surface) {
                const double opacity = world.opacity_of(surface, ray.origin);
                const std::uint32_t id = grids.id_of(surface);
                const double stop = stops.at(crossing++);
                if (opacity <= 0) return true;
                if (opacity < 1) {
                    const ListNode node{id, float(surface.t), float(opacity), std::uint32_t(sample)};
                    if (traced.lists->add(x, y, node) || stop >= opacity) return true;
                }
                end = id;
                return false;
            });
        });
    return traced;
}

}  // namespace

std::optional<Visibility> parse_visibility(std::string_view name) {
    return value_named(kVisibilityNames, name);
}

std::string_view visibility_name(Visibility visibility) {
    return name_of(kVisibilityNames, visibility);
}

std::vector<std::uint32_t> trace_ids(const SceneRenderer& renderer, const ShadingGrids& grids, int frame,
                                     const VisibilitySettings& settings) {
    std::vector<std::uint32_t> ids(pixel_count(renderer) * std::size_t(settings.samples), kNoShading);
    renderer.for_each_sample(
        frame, truth_of(settings), [&](int x, int y, int sample, const World& world, const Ray& ray) {
            const auto surface = trace_sample(world, ray, settings, frame, x, y, sample);
            if (!surface) return;
            ids[pixel_of(renderer, x, y) * std::size_t(settings.samples) + std::size_t(sample)] =
                grids.id_of(*surface);
        });
    return ids;
}

Image resolve_light(const SceneRenderer& renderer, const ShadingGrids& grids,
                    std::span<const std::uint32_t> ids, const SampleIds& addresses) {
    return blend(renderer, shade_all(renderer, grids, ids), addresses, nullptr);
}

LitSamples::LitSamples(int width_px, int height_px)
    : sums(std::size_t(width_px) * std::size_t(height_px)), shadings(sums.size()), met(sums.size()) {}

LitSamples light_samples(const SceneRenderer& renderer, int frame, const VisibilitySettings& settings) {
    LitSamples lit(renderer.width_px(), renderer.height_px());
    const bool sorted = settings.transparency.transparency == Transparency::sorted;
    renderer.for_each_sample(
        frame, truth_of(settings), [&](int x, int y, int sample, const World& world, const Ray& ray) {
            const std::size_t pixel = pixel_of(renderer, x, y);
            if (sorted) {
                int own = 0;
                lit.sums[pixel] += world.radiance(ray, &own);
                lit.shadings[pixel] += std::uint32_t(own);
                lit.met[pixel] += own > 0 ? 1 : 0;
                return;
            }
            auto surface = trace_sample(world, ray, settings, frame, x, y, sample);
            if (surface)
                surface->light_seed =
                    light_seed(StopNumbers::pixel_seed(settings.seed, frame, x, y), std::uint32_t(sample));
            lit.sums[pixel] +=
                surface ? world.shade(*surface, ray.origin).color() : renderer.scene().background;
            lit.shadings[pixel] += surface ? 1 : 0;
            lit.met[pixel] += surface ? 1 : 0;
        });
    return lit;
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
                                    const VisibilitySettings& settings, const VisibilityPasses& passes,
                                    KeptShadings* kept) {
    if (settings.visibility != Visibility::memoised)
        return render_plain(renderer, frame, settings, passes.light);
    const ShadingGrids grids = kept ? kept->next_frame(renderer, frame, settings.grid)
                                    : ShadingGrids(renderer, frame, settings.grid);
    Traced traced;
    if (settings.transparency.transparency == Transparency::lists)
        traced = trace_lists(renderer, grids, frame, settings);
    else traced.ends = passes.trace(renderer, grids, frame, settings);
    return render_memoised(renderer, grids, frame, settings, traced, passes, kept);
}

}  // namespace aftershade::scene
