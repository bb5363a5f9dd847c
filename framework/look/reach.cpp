#include "framework/look/reach.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <variant>
#include <vector>

#include "framework/capture/capture_window.h"
#include "framework/effect/manifest/manifest_expand.h"

namespace aftershade {
namespace {

/// Parts that begin on coarser grids than this are hardly smaller than the frame.
constexpr int kMostAlignPx = 256;

std::optional<double> number_of(const ParamValue& value) {
    if (const auto* number = std::get_if<double>(&value)) return *number;
    if (const auto* integer = std::get_if<std::int64_t>(&value)) return double(*integer);
    return std::nullopt;
}

/// The greatest value that the parameter may have in any frame.
double most_of(const PipelineStep& step, const ParamSpec& spec) {
    const bool is_asked = step.values.contains(spec.name);
    const std::vector<ParamValue> values = step.known_values(spec);
    const double limit = spec.max.value_or(0);
    if (values.empty() || (!is_asked && !spec.from.empty())) return limit;
    double most = 0;
    for (const ParamValue& value : values) most = std::max(most, number_of(value).value_or(limit));
    return most;
}

/// Px as rendered; nullopt: all.
std::optional<int> reach_of(const PipelineStep& step, double scale) {
    const EffectManifest& manifest = *step.manifest;
    if (!manifest.reach)
        return is_pointwise(manifest) && !manifest.counts_from_part ? std::optional(0) : std::nullopt;
    if (manifest.reach->is_all) return std::nullopt;
    int reach = manifest.reach->px;
    for (const std::string& name : manifest.reach->params)
        reach += int(std::ceil(most_of(step, *manifest.find_param(name)) * scale));
    return reach;
}

/// The least number of px that texels of this scale, or several of them, end with; 0: more than kMostAlignPx.
int px_of_whole_texels(double scale) {
    for (int px = 1; px <= kMostAlignPx; ++px)
        if (std::abs(px * scale - std::round(px * scale)) < 1e-9) return px;
    return 0;
}

class Alignment {
public:
    explicit Alignment(const PipelineStep& step) : step_(step) {}

    /// Everything that the effect counts from the corner of the frame; 0: no part of the frame will do.
    int of_step() {
        const EffectManifest& manifest = *step_.manifest;
        for (const TextureSpec& texture : manifest.textures) {
            if (texture.grid.kind == GridSpec::Kind::size) continue;
            if (texture.auto_mips) return 0;
            add_grid(texture.grid, 1 << (texture.mips - 1));
        }
        for (const BufferSpec& buffer : manifest.buffers)
            if (buffer.grid) add_grid(*buffer.grid, 1);
        for (const TileListSpec& list : manifest.tiles)
            if (list.on.empty()) add(count(list.tile));
            else add_grid(manifest.find_texture(list.on)->grid, count(list.tile));
        for (const PassSpec& pass : manifest.passes)
            if (const ComputeSpec* compute = pass.compute();
                compute && compute->dispatch.kind == DispatchSpec::Kind::tile &&
                compute->dispatch.over.empty() && !compute->lists)
                add(count(compute->dispatch.tile));
        return px_;
    }

private:
    void add(int px) { px_ = px < 1 || px_ < 1 ? 0 : std::lcm(px_, px); }
    void add_grid(const GridSpec& grid, int texels) {
        if (grid.kind == GridSpec::Kind::tile) add(count(grid.tile) * texels);
        else if (grid.kind == GridSpec::Kind::scale) add(px_of_whole_texels(grid.scale) * texels);
    }
    /// 0 where it is not the same for all frames.
    int count(const CountSpec& count) const {
        if (count.param.empty()) return count.number;
        const ParamSpec& spec = *step_.manifest->find_param(count.param);
        const std::vector<ParamValue> values = step_.known_values(spec);
        const bool is_taken = !step_.values.contains(spec.name) && !spec.from.empty();
        return values.size() == 1 && !is_taken ? int(number_of(values.front()).value_or(0)) : 0;
    }

    const PipelineStep& step_;
    int px_ = 1;
};

bool needs_all(const PipelineStep& step) {
    // Where a surface was in another frame is as far as it moves.
    const auto is_of_another_frame = [&](const InputSpec& input) {
        return input.frame != 0 && step.may_take(input);
    };
    const auto is_of_pixels = [](const auto& value) { return !pixel_values(value.second).empty(); };
    return step.manifest->has_history() || std::ranges::any_of(step.manifest->inputs, is_of_another_frame) ||
           std::ranges::any_of(step.values, is_of_pixels) || !pixel_values(step.mix).empty() ||
           (step.mask && !step.mask->file.empty());
}

}  // namespace

std::optional<RegionNeeds> needs_of_region(const Pipeline& pipeline, double scale) {
    RegionNeeds needs;
    std::vector<int> margins(pipeline.steps.size(), 0);  // around what later steps need of each
    for (int i = int(pipeline.steps.size()) - 1; i >= 0; --i) {
        const PipelineStep& step = pipeline.steps[std::size_t(i)];
        const std::optional<int> reach = reach_of(step, scale);
        const int align_px = Alignment(step).of_step();
        if (!reach || align_px < 1 || needs_all(step)) return std::nullopt;
        needs.align_px = std::lcm(needs.align_px, align_px);
        if (needs.align_px > kMostAlignPx) return std::nullopt;
        const int around_px = margins[std::size_t(i)] + *reach;
        needs.margin_px = std::max(needs.margin_px, around_px);
        for (const auto* sources : {&step.inputs, &step.before})
            for (const auto& [name, source] : *sources)
                if (source.step >= 0) {
                    int& margin_px = margins[std::size_t(source.step)];
                    margin_px = std::max(margin_px, around_px);
                }
    }
    return needs;
}

std::optional<RegionNeeds> in_stored_pixels(const RegionNeeds& needs, const PixelStretch& stretch) {
    if (stretch.is_none() || needs.align_px == 1) return needs;
    for (int px = needs.align_px; px <= kMostAlignPx; px += needs.align_px)
        if (px * stretch.to % (stretch.from * needs.align_px) == 0) return RegionNeeds{needs.margin_px, px};
    return std::nullopt;
}

Window window_with_needs(const Window& region, const RegionNeeds& needs, const Window& data) {
    const auto before = [&](int value, int origin) {
        return origin + int(std::floor(double(value - origin) / needs.align_px)) * needs.align_px;
    };
    const auto after = [&](int value, int origin) {
        return origin + int(std::ceil(double(value + 1 - origin) / needs.align_px)) * needs.align_px - 1;
    };
    return intersection({before(region.min_x - needs.margin_px, data.min_x),
                         before(region.min_y - needs.margin_px, data.min_y),
                         after(region.max_x + needs.margin_px, data.min_x),
                         after(region.max_y + needs.margin_px, data.min_y)},
                        data);
}

}  // namespace aftershade
