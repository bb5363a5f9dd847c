// Values over time, in frames. Frame 3 is the time 3.0; the shutter of frame 3 is open around it.
#pragma once

#include <algorithm>
#include <utility>
#include <vector>

namespace aftershade::scene {

/// Between keys: a line; the earlier key until the next; or a cubic that rests at each key (smoothstep).
enum class Interpolation { linear, step, smooth };

/// The frames between two cuts. An object keeps its motion over a shot's ends: the exposure and the motion
/// vectors of a shot's first frame see nothing of the shot before it.
struct Shot {
    double first = -1e9;
    double last = 1e9;
};

/// T has + and -, and * with a double.
template <class T>
class Animated {
public:
    struct Key {
        double frame = 0;
        T value{};
    };

    Animated() : Animated(T{}) {}
    Animated(const T& constant) : keys_{{0, constant}} {}
    /// At least one key; their frames ascend.
    Animated(std::vector<Key> keys, Interpolation interpolation)
        : keys_(std::move(keys)), interpolation_(interpolation) {}

    bool is_constant() const { return keys_.size() == 1; }
    const std::vector<Key>& keys() const { return keys_; }
    Interpolation interpolation() const { return interpolation_; }

    /// The first and last key hold outside the keys.
    T at(double time) const {
        const auto after = std::upper_bound(keys_.begin(), keys_.end(), time,
                                            [](double t, const Key& key) { return t < key.frame; });
        if (after == keys_.begin()) return keys_.front().value;
        const Key& from = *(after - 1);
        if (after == keys_.end() || interpolation_ == Interpolation::step) return from.value;
        double t = (time - from.frame) / (after->frame - from.frame);
        if (interpolation_ == Interpolation::smooth) t = t * t * (3 - 2 * t);
        return from.value + (after->value - from.value) * t;
    }

    /// The same inside `shot`. Outside, the curve continues as its mirror image through the shot's end, so
    /// that position and speed are continuous; where the shot is too short for that, and between steps, the
    /// end holds.
    T at(double time, const Shot& shot) const {
        return at(time, shot, [](const T& end, const T& mirrored) { return end + (end - mirrored); });
    }

    /// The same for values above 0, which stay above it: the curve of their logarithm is what continues.
    T positive_at(double time, const Shot& shot) const {
        return at(time, shot, [](const T& end, const T& mirrored) { return end * (end / mirrored); });
    }

private:
    template <class GoOn>
    T at(double time, const Shot& shot, const GoOn& go_on) const {
        const double end = std::clamp(time, shot.first, shot.last);
        if (end == time) return at(time);
        const double mirrored = 2 * end - time;
        const bool inside = mirrored >= shot.first && mirrored <= shot.last;
        if (!inside || interpolation_ == Interpolation::step) return at(end);
        return go_on(at(end), at(mirrored));
    }

    std::vector<Key> keys_;
    Interpolation interpolation_ = Interpolation::linear;
};

}  // namespace aftershade::scene
