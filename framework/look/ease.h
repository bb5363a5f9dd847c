// How a value goes from one key over frames to the next.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "framework/document/document.h"

namespace aftershade {

struct Ease {
    enum class Kind {
        linear,
        smooth,  ///< eases out of the key and into the next one
        step,    ///< holds the key's value
        curve    ///< a cubic Bezier curve
    };
    Kind kind = Kind::linear;
    /// x1, y1, x2, y2 of a curve's handles, from 0 to 1: x is the share of the frames between the keys, y
    /// that of the change. The curve goes from (0, 0) to (1, 1), as `cubic-bezier()` in CSS Easing Functions
    /// Level 1.
    std::array<double, 4> handles{};

    /// Share of the change at a share of the frames, both from 0 to 1.
    double share(double of_frames) const;
};

/// The reader's key 'interpolation'; nullopt where it is absent or, with an error, is neither a word nor
/// handles.
std::optional<Ease> read_ease(ObjectReader& reader, const std::string& label, Diagnostics& diagnostics);

/// As a document writes it: "smooth" in quotes, or [0.4, 0, 0.6, 1].
std::string format_ease(const Ease& ease);

/// "linear", "smooth", "step"; a curve has handles in place of a word.
const std::vector<std::string>& ease_names();

}  // namespace aftershade
