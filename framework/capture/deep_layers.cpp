#include "framework/capture/deep_layers.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

namespace aftershade {

/// One sample of a pixel.
struct DeepSample {
    std::uint32_t index = 0;
    double front = 0;
    double back = 0;
    double alpha = 1;

    /// At one depth points come first; then opaque volumes, which hide all behind their front; then others.
    int rank() const { return back <= front ? 0 : alpha >= 1 ? 1 : 2; }
    bool is_point() const { return rank() < 2; }
    double end() const { return is_point() ? front : back; }
    double middle() const { return std::isfinite(back) && back > front ? (front + back) / 2 : front; }
    /// -ln(1 - alpha): of the whole sample.
    double thickness() const { return -std::log1p(-alpha); }
};

namespace {

/// Of the depths on both sides; a surface seen at a slant within a pixel stays in one layer.
constexpr double kLeastGap = 0.01;
constexpr std::size_t kMostGroups = 63;  ///< gaps that are weighed against each other
constexpr double kLeastDepth = 1e-6;     ///< what is nearer, or behind the camera, has no reciprocal

double known(float value, double otherwise) {
    return std::isnan(value) ? otherwise : double(value);
}

double gap_between(double end, double next) {
    if (!(next > end)) return 0;
    return end > 0 ? std::log(next / end) : std::numeric_limits<double>::infinity();
}

/// (1 - e^-u) / u: what a volume of thickness u shows of its light.
double shown_of(double u) {
    return u < 1e-9 ? 1 : -std::expm1(-u) / u;
}

/// How much light is left behind the samples so far, and what each of those that are open has shown: within
/// an interval a volume of density d shows d / alpha times the growth of `seen` (Kainz 2013, "Volumetric
/// samples", in the limit of many intervals between the same depths).
class Medium {
public:
    void advance(double to) {
        const double length = to - at_;
        if (length > 0 && open_ > 0 && std::isfinite(length)) {
            const double u = density_ * length;
            seen_ += left_ * shown_of(u) * length;
            left_ *= std::exp(-u);
        }
        at_ = to;
    }
    void enter(double density) { density_ += density, ++open_; }
    void leave(double density) { density_ = --open_ == 0 ? 0 : std::max(0.0, density_ - density); }
    double seen() const { return seen_; }
    double left() const { return left_; }
    void leave_only(double share) { left_ *= share; }

private:
    double at_ = 0, density_ = 0, seen_ = 0, left_ = 1;
    int open_ = 0;
};

double density_of(const DeepSample& sample) {
    return sample.thickness() / (sample.back - sample.front);
}

/// Of a volume's values for each unit of `seen`.
double rate_of(const DeepSample& sample) {
    const double length = sample.back - sample.front;
    return sample.alpha > 0 ? sample.thickness() / (sample.alpha * length) : 1 / length;
}

/// What samples at one depth show of themselves, in `shares`; returns what they let through. Merged two at a
/// time, in the file's order, as Kainz 2013, "Merging overlapping samples", has it: translucent ones add up
/// their thickness, opaque ones hide these and are averaged.
double merge_coincident(std::span<const DeepSample> samples, std::span<double> shares) {
    std::size_t opaque = 0;
    double thickness = 0, left = 1;
    for (const DeepSample& sample : samples) {
        opaque += sample.alpha >= 1 ? 1 : 0;
        left *= 1 - sample.alpha;
        if (sample.alpha < 1) thickness += sample.thickness();
    }
    std::size_t before = 0;  // opaque ones
    for (std::size_t i = 0; i < samples.size(); ++i) {
        const double alpha = samples[i].alpha;
        if (opaque == 0) shares[i] = (alpha > 0 ? samples[i].thickness() / alpha : 1) * shown_of(thickness);
        else if (alpha < 1) shares[i] = 0;
        else shares[i] = std::pow(0.5, double(opaque - std::max<std::size_t>(before++, 1)));
    }
    return left;
}

/// The shares of one layer's samples, which are sorted by their front.
std::vector<double> shares_of(std::span<const DeepSample> samples) {
    std::vector<double> shares(samples.size());
    std::vector<std::size_t> ends;  // of volumes, by their back
    for (std::size_t i = 0; i < samples.size(); ++i)
        if (!samples[i].is_point()) ends.push_back(i);
    std::sort(ends.begin(), ends.end(),
              [&](std::size_t a, std::size_t b) { return samples[a].back < samples[b].back; });
    Medium medium;
    medium.advance(samples.front().front);
    std::size_t closed = 0;
    const auto close_before = [&](double depth) {
        for (; closed < ends.size() && samples[ends[closed]].back <= depth; ++closed) {
            const DeepSample& volume = samples[ends[closed]];
            medium.advance(volume.back);
            medium.leave(density_of(volume));
            shares[ends[closed]] = rate_of(volume) * (medium.seen() - shares[ends[closed]]);
        }
        medium.advance(depth);
    };
    for (std::size_t i = 0; i < samples.size(); ++i) {
        close_before(samples[i].front);
        if (samples[i].is_point()) {
            const auto is_other = [&](const DeepSample& sample) {
                return sample.front != samples[i].front || sample.rank() != samples[i].rank();
            };
            const auto end = std::find_if(samples.begin() + std::ptrdiff_t(i), samples.end(), is_other);
            const auto count = std::size_t(end - samples.begin()) - i;
            const std::span<double> merged = std::span(shares).subspan(i, count);
            const double left = merge_coincident(samples.subspan(i, count), merged);
            for (double& share : merged) share *= medium.left();
            medium.leave_only(left);
            i += count - 1;
            continue;
        }
        shares[i] = medium.seen();  // until it closes
        medium.enter(density_of(samples[i]));
    }
    if (!ends.empty()) close_before(samples[ends.back()].back);
    return shares;
}

}  // namespace

/// One pixel's way into layers; its vectors are kept for the next.
class DeepPixel {
public:
    DeepPixel(const DeepGeometry& geometry, DeepLayers& layers) : geometry_(geometry), layers_(layers) {}

    void add(std::size_t pixel) {
        gather(pixel);
        if (samples_.empty()) return;
        split();
        double shift = 0, weight = 0;
        for (std::size_t layer = 0; layer + 1 < bounds_.size(); ++layer)
            fill(pixel, int(layer),
                 std::span(samples_).subspan(bounds_[layer], bounds_[layer + 1] - bounds_[layer]), shift,
                 weight);
        DeepReduction& reduction = layers_.reduction_;
        reduction.samples += samples_.size();
        reduction.most_samples = std::max<std::uint64_t>(reduction.most_samples, samples_.size());
        ++reduction.pixels;
        sum_shift_ += shift;
        sum_weight_ += weight;
        if (weight > 0) reduction.most_shift = std::max(reduction.most_shift, shift / weight);
    }

    void finish() { layers_.reduction_.mean_shift = sum_weight_ > 0 ? sum_shift_ / sum_weight_ : 0; }

private:
    void gather(std::size_t pixel) {
        samples_.clear();
        constexpr double kFar = std::numeric_limits<double>::infinity();
        bool is_known = true;
        for (std::uint32_t i = geometry_.first[pixel]; i < geometry_.first[pixel + 1]; ++i) {
            DeepSample sample{i, known(geometry_.front[i], kFar), 0, 1};
            is_known &= !std::isnan(geometry_.front[i]);
            sample.back = geometry_.back.empty() ? sample.front : known(geometry_.back[i], sample.front);
            if (!std::isfinite(sample.back) || !std::isfinite(sample.front)) sample.back = sample.front;
            if (!geometry_.alpha.empty()) sample.alpha = std::clamp(known(geometry_.alpha[i], 0), 0.0, 1.0);
            samples_.push_back(sample);
        }
        if (!is_known && layers_.reduction_.nan_pixels++ == 0) layers_.reduction_.first_nan = pixel;
        std::stable_sort(samples_.begin(), samples_.end(), [](const DeepSample& a, const DeepSample& b) {
            return a.front != b.front ? a.front < b.front : a.rank() < b.rank();
        });
    }

    /// Where layers begin, and the end.
    void split() {
        bounds_ = {0};
        gaps_.clear();
        double end = samples_.front().end();
        for (std::size_t i = 1; i < samples_.size(); ++i) {
            const double gap = gap_between(end, samples_[i].front);
            if (gap > kLeastGap) gaps_.push_back({gap, i});
            end = std::max(end, samples_[i].end());
        }
        const auto most = std::size_t(layers_.layers_ - 1);
        if (gaps_.size() > most) {
            ++layers_.reduction_.merged_pixels;
            keep_widest(kMostGroups);
        }
        for (const Gap& gap : gaps_) bounds_.push_back(gap.before);
        bounds_.push_back(samples_.size());
        if (gaps_.size() > most) merge_groups();
    }

    /// So that the time for a pixel of many samples stays level.
    void keep_widest(std::size_t most) {
        if (gaps_.size() <= most) return;
        std::stable_sort(gaps_.begin(), gaps_.end(),
                         [](const Gap& a, const Gap& b) { return a.width > b.width; });
        gaps_.resize(most);
        std::sort(gaps_.begin(), gaps_.end(), [](const Gap& a, const Gap& b) { return a.before < b.before; });
    }

    /// Takes away bounds until there are as few layers as may be: each time the one whose loss moves the
    /// least light in depth, as a lens sees depth, by its reciprocal; of equals the furthest. Of what is
    /// hidden, which moves no light, the nearest thus stays by itself.
    void merge_groups() {
        struct Group {
            double alpha = 0, most = 0, depth = 0;
        };
        std::vector<Group> groups;
        for (std::size_t g = 0; g + 1 < bounds_.size(); ++g) {
            const auto samples = std::span(samples_).subspan(bounds_[g], bounds_[g + 1] - bounds_[g]);
            const std::vector<double> shares = shares_of(samples);
            Group group{0, -1, 0};
            for (std::size_t i = 0; i < samples.size(); ++i) {
                const double shows = shares[i] * samples[i].alpha;
                group.alpha += shows;
                if (shows > group.most) group.most = shows, group.depth = samples[i].middle();
            }
            groups.push_back(group);
        }
        const auto moved = [&](std::size_t g) {
            const Group &front = groups[g], &back = groups[g + 1];
            const double nearness =
                1 / std::max(front.depth, kLeastDepth) - 1 / std::max(back.depth, kLeastDepth);
            return std::min(front.alpha, (1 - front.alpha) * back.alpha) * nearness;
        };
        while (groups.size() > std::size_t(layers_.layers_)) {
            std::size_t least = groups.size() - 2;
            for (std::size_t g = least; g-- > 0;)
                if (moved(g) < moved(least)) least = g;
            Group &front = groups[least], &back = groups[least + 1];
            const double left = std::max(0.0, 1 - front.alpha);
            front.alpha += left * back.alpha;
            if (left * back.most > front.most) front.most = left * back.most, front.depth = back.depth;
            groups.erase(groups.begin() + std::ptrdiff_t(least) + 1);
            bounds_.erase(bounds_.begin() + std::ptrdiff_t(least) + 1);
        }
    }

    void fill(std::size_t pixel, int layer, std::span<const DeepSample> samples, double& shift,
              double& weight) {
        const std::vector<double> shares = shares_of(samples);
        std::size_t shown = 0;
        double alpha = 0, most = -1;
        for (std::size_t i = 0; i < samples.size(); ++i) {
            layers_.layer_[samples[i].index] = std::uint8_t(layer);
            layers_.share_[samples[i].index] = float(shares[i]);
            const double shows = shares[i] * samples[i].alpha;
            alpha += shows;
            if (shows > most) most = shows, shown = i;
        }
        layers_.alpha_[layers_.at(pixel, layer)] = float(std::min(alpha, 1.0));
        layers_.shown_[layers_.at(pixel, layer)] = samples[shown].index;
        const double depth = samples[shown].middle();
        for (std::size_t i = 0; i < samples.size(); ++i) {
            const double ratio = samples[i].middle() / depth;
            if (ratio > 0 && std::isfinite(ratio))
                shift += shares[i] * samples[i].alpha * std::abs(std::log(ratio));
        }
        weight += alpha;
    }

    struct Gap {
        double width = 0;
        std::size_t before = 0;
    };
    const DeepGeometry& geometry_;
    DeepLayers& layers_;
    std::vector<DeepSample> samples_;
    std::vector<Gap> gaps_;
    std::vector<std::size_t> bounds_;
    double sum_shift_ = 0, sum_weight_ = 0;
};

DeepLayers::DeepLayers(const DeepGeometry& geometry, int layers) : layers_(layers), first_(geometry.first) {
    const std::size_t pixels = geometry.first.empty() ? 0 : geometry.first.size() - 1;
    layer_.resize(geometry.front.size());
    share_.resize(geometry.front.size());
    alpha_.resize(pixels * std::size_t(layers));
    shown_.assign(pixels * std::size_t(layers), kNoSample);
    DeepPixel pixel(geometry, *this);
    for (std::size_t i = 0; i < pixels; ++i) pixel.add(i);
    pixel.finish();
}

float DeepLayers::blended(std::span<const float> values, std::size_t pixel, int layer) const {
    double sums[kMostLayers] = {};
    for (std::uint32_t i = first_[pixel]; i < first_[pixel + 1]; ++i)
        if (share_[i] != 0) sums[layer_[i]] += double(share_[i]) * double(values[i]);
    if (layer >= 0) return float(sums[layer]);
    double sum = 0, left = 1;
    for (int k = 0; k < layers_; ++k) {
        if (sums[k] != 0 && left > 0) sum += left * sums[k];
        left *= 1 - double(alpha_[at(pixel, k)]);
    }
    return float(sum);
}

float DeepLayers::alpha(std::size_t pixel, int layer) const {
    if (layer >= 0) return alpha_[at(pixel, layer)];
    double left = 1;
    for (int k = 0; k < layers_; ++k) left *= 1 - double(alpha_[at(pixel, k)]);
    return float(1 - left);
}

std::uint32_t DeepLayers::shown(std::size_t pixel, int layer) const {
    if (layer >= 0) return shown_[at(pixel, layer)];
    std::uint32_t shown = kNoSample;
    double left = 1, most = -1;
    for (int k = 0; k < layers_; ++k) {
        const double alpha = double(alpha_[at(pixel, k)]);
        if (shown_[at(pixel, k)] != kNoSample && left * alpha > most)
            most = left * alpha, shown = shown_[at(pixel, k)];
        left *= 1 - alpha;
    }
    return shown;
}

std::string DeepReduction::text(int layers) const {
    const double each = pixels > 0 ? double(samples) / double(pixels) : 0;
    const std::string found = fmt::format("{} deep samples, {:.3g} in a pixel that has any and {} at most, ",
                                          samples, each, most_samples);
    if (layers == 1) return found + "are put over one another";
    const double share = pixels > 0 ? 100.0 * double(merged_pixels) / double(pixels) : 0;
    return found + fmt::format(
                       "are reduced to {} layers: {:.2g} % of these pixels have more gaps in depth, and "
                       "samples move by {:.2g} % of their depth on average, by {:.2g} % in the worst pixel",
                       layers, share, 100 * mean_shift, 100 * most_shift);
}

}  // namespace aftershade
