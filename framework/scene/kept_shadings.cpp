#include "framework/scene/kept_shadings.h"

#include <algorithm>
#include <utility>

#include "framework/base/parallel.h"

namespace aftershade::scene {

using glm::dvec3;

namespace {

/// Where the things that cast shadows and moved were and are.
Bvh boxes_of_moved(const World& then, const World& now) {
    std::vector<Bounds> boxes;
    for (std::size_t i = 0; i < now.scene().objects.size(); ++i) {
        if (!now.scene().objects[i].casts_shadow || now.bounds(int(i)).empty() ||
            then.state().world_from_object[i] == now.state().world_from_object[i])
            continue;
        boxes.push_back(then.bounds(int(i)));
        boxes.push_back(now.bounds(int(i)));
    }
    return build_bvh(boxes, 1);
}

}  // namespace

std::span<double> KeptShadings::seen_of(std::size_t sample) {
    return std::span(seen_).subspan(sample * lights_, lights_);
}

std::uint64_t KeptShadings::bytes_of_sample(std::size_t lights) {
    const std::uint64_t of_index = sizeof(std::uint64_t) + sizeof(std::uint32_t);
    return sizeof(Sample) + lights * sizeof(double) + of_index;
}

double KeptShadings::samples_of_pixel(int samples, double shading_rate) {
    const double cells = shading_rate * kFiner * shading_rate * kFiner;
    return std::min(double(samples), 4 * cells);
}

ShadingGrids KeptShadings::next_frame(const SceneRenderer& renderer, int frame,
                                      const ShadingGridSettings& settings) {
    ShadingGrids grids(renderer, frame, settings, earlier_ ? &*earlier_ : nullptr);
    lights_ = renderer.scene().lights.size();
    ++frames_;
    if (!samples_.empty()) drop_changed(renderer, grids, frame);
    earlier_ = grids.of_frame();
    return grids;
}

void KeptShadings::drop_changed(const SceneRenderer& renderer, const ShadingGrids& grids, int frame) {
    const World then = renderer.world_at(earlier_->frame, earlier_->frame);
    const World now = renderer.world_at(frame, frame);
    std::vector<char> is_stale(samples_.size(), then.state().lights != now.state().lights);
    const Bvh moved = boxes_of_moved(then, now);
    for_each_index(samples_.size(), renderer.threads(), [&](std::size_t i) {
        const Sample& sample = samples_[i];
        const TriangleGrid& grid = grids.grids()[sample.triangle];
        if (grid.camera == 0 || frames_ - sample.last_used > kUnusedFrames) is_stale[i] = 1;
        if (is_stale[i] || moved.nodes.empty()) return;
        if (now.light_meets(grids.surface_of(2 * grid.start + sample.cell, sample.ray_id), moved))
            is_stale[i] = 1;
    });
    drop(is_stale);
}

void KeptShadings::drop(const std::vector<char>& is_stale) {
    std::size_t kept = 0;
    for (std::size_t i = 0; i < samples_.size(); ++i) {
        if (is_stale[i]) {
            index_.erase(samples_[i].key());
            continue;
        }
        if (kept < i) {
            index_[samples_[i].key()] = std::uint32_t(kept);
            samples_[kept] = samples_[i];
            std::ranges::copy(seen_of(i), seen_of(kept).begin());
        }
        ++kept;
    }
    samples_.resize(kept);
    seen_.resize(kept * lights_);
}

std::size_t KeptShadings::find_or_add(const ShadingGrids& grids, std::uint32_t id, char& is_new) {
    Sample sample;
    sample.triangle = grids.triangle_of(id);
    sample.cell = id - 2 * grids.grids()[sample.triangle].start;
    sample.ray_id = id;
    const auto [at, added] = index_.try_emplace(sample.key(), std::uint32_t(samples_.size()));
    is_new = added;
    if (added) {
        samples_.push_back(sample);
        seen_.resize(samples_.size() * lights_);
    }
    samples_[at->second].last_used = frames_;
    return at->second;
}

KeptShadings::Lit KeptShadings::light(const SceneRenderer& renderer, const ShadingGrids& grids,
                                      std::span<const std::uint32_t> ids) {
    Lit lit{std::vector<dvec3>(ids.size()), std::vector<char>(ids.size())};
    std::vector<std::size_t> sample_of(ids.size());
    for (std::size_t i = 0; i < ids.size(); ++i) sample_of[i] = find_or_add(grids, ids[i], lit.is_new[i]);
    const dvec3 eye(grids.reference().camera.world_from_camera[3]);
    std::vector<char> has_highlight(ids.size());
    for_each_index(ids.size(), renderer.threads(), [&](std::size_t i) {
        Sample& sample = samples_[sample_of[i]];
        const std::span<double> seen = seen_of(sample_of[i]);
        if (lit.is_new[i]) {
            sample.shading = grids.shading(ids[i], seen);
        } else if (std::ranges::any_of(seen, [](double part) { return part > 0; })) {
            const Surface surface = grids.surface_of(ids[i], sample.ray_id);
            const Material& material = grids.world().material_at(surface);
            has_highlight[i] = material.specular > 0 || material.metallic > 0;
            if (has_highlight[i]) sample.shading.specular = grids.world().highlights(surface, eye, seen);
        }
        lit.light[i] = sample.shading.color();
    });
    lit.highlight_count = std::uint64_t(std::ranges::count(has_highlight, 1));
    return lit;
}

}  // namespace aftershade::scene
