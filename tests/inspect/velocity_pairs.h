// Two frames and their vectors, for tests of the velocity check.
#pragma once

#include "framework/image/image.h"
#include "framework/inspect/velocity_check.h"

namespace aftershade::test {

/// Two frames with the vectors of both roles, canonical.
struct Pair {
    Image color_a, color_b, velocity_a, velocity_b, next_a, next_b;
};

inline VelocityCheckInput claim_velocity(const Pair& pair, VelocitySettings settings = {}) {
    return {&pair.color_a, &pair.color_b, &pair.velocity_a, &pair.velocity_b, settings};
}

inline VelocityCheckInput claim_next(const Pair& pair) {
    return {&pair.color_a, &pair.color_b, &pair.next_a, &pair.next_b, {.delta = "next-cur"}};
}

/// What a decoding that is wrong in this way makes of right vectors.
inline Image undo(const Image& right, const VelocityHypothesis& hypothesis) {
    Image wrong = right;
    for (int y = 0; y < right.height(); ++y)
        for (int x = 0; x < right.width(); ++x) {
            const float u = right.at(x, y, 0) / float(hypothesis.scale_x);
            const float v = right.at(x, y, 1) / float(hypothesis.scale_y);
            wrong.at(x, y, 0) = hypothesis.swapped ? v : u;
            wrong.at(x, y, 1) = hypothesis.swapped ? u : v;
        }
    return wrong;
}

}  // namespace aftershade::test
