#include "framework/capture/sample_means.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

namespace aftershade {

namespace {

/// A filter of a renderer reaches two pixels to either side (Mitsuba's Gaussian); the tails beyond count as
/// surface.
constexpr int kMostMixed_px = 3;
/// What counts as an edge.
struct Edge {
    double steeper;     ///< than the surfaces beside it, at least
    double least_jump;  ///< as a share of the values, which half floats resolve to 0.001
};
constexpr Edge kEdge = {4, 5e-3};
/// So steep that a pixel of a mixture does not pass for a surface, so high that noise does not pass for an
/// edge.
constexpr Edge kSureEdge = {30, 0.02};
/// Means of floats that are equal differ by less.
constexpr double kRounding = 1e-4;
/// From the line between two values, as a share of its length: means of normals that were made unit vectors
/// again lie beside it, by 0.21 for normals at right angles.
constexpr double kBeside = 0.25;

struct Step {
    int x = 0, y = 0;
};
constexpr std::array<Step, 4> kLines = {Step{1, 0}, Step{0, 1}, Step{1, 1}, Step{1, -1}};

class Values {
public:
    explicit Values(const Image& image) : image_(image), channels_(std::min(image.channels(), 3)) {}

    bool has(int x, int y) const { return x >= 0 && y >= 0 && x < image_.width() && y < image_.height(); }
    glm::dvec3 at(int x, int y) const {
        glm::dvec3 value(0);
        for (int c = 0; c < channels_; ++c) value[c] = image_.at(x, y, c);
        return value;
    }

private:
    const Image& image_;
    int channels_;
};

bool is_finite(const glm::dvec3& value) {
    return std::isfinite(value.x + value.y + value.z);
}

/// A surface beside a pixel, continued to it.
struct Side {
    glm::dvec3 value{0};  ///< at the pixel
    double slope = 0;     ///< change a pixel
};

/// By the pixels `distance` and `distance + 1` steps away.
std::optional<Side> side_of(const Values& values, int x, int y, Step step, int distance) {
    const int near_x = x + distance * step.x, near_y = y + distance * step.y;
    if (!values.has(near_x + step.x, near_y + step.y)) return std::nullopt;
    const glm::dvec3 near = values.at(near_x, near_y), far = values.at(near_x + step.x, near_y + step.y);
    if (!is_finite(near) || !is_finite(far)) return std::nullopt;
    return Side{near + double(distance) * (near - far), glm::length(near - far)};
}

bool is_edge(const Side& a, const Side& b, const Edge& edge) {
    const double jump = glm::length(b.value - a.value);
    return jump > edge.steeper * (a.slope + b.slope) +
                      edge.least_jump * std::min(glm::length(a.value), glm::length(b.value));
}

/// How far `value` has gone from `a` (0) to `b` (1); nullopt where it is one of them, or not between them.
std::optional<double> share_of(const glm::dvec3& value, const Side& a, const Side& b) {
    const glm::dvec3 jump = b.value - a.value;
    const double length = glm::length(jump);
    const double share = glm::dot(value - a.value, jump) / (length * length);
    if (glm::length(value - a.value - share * jump) > kBeside * length) return std::nullopt;
    if (share * length <= a.slope + kRounding * glm::length(a.value)) return std::nullopt;
    if ((1 - share) * length <= b.slope + kRounding * glm::length(b.value)) return std::nullopt;
    return share;
}

/// Whether the values from one side to the other all go towards it: an object that is between them in depth
/// has pixels that are alike.
bool rises(const Values& values, int x, int y, Step step, int from, int to, const glm::dvec3& jump) {
    const double least = kRounding * glm::dot(jump, jump);
    for (int i = from; i < to; ++i) {
        const glm::dvec3 one = values.at(x + i * step.x, y + i * step.y),
                         next = values.at(x + (i + 1) * step.x, y + (i + 1) * step.y);
        if (!(glm::dot(next - one, jump) > least)) return false;
    }
    return true;
}

struct Repair {
    glm::dvec3 value{0};
    double unsteadiness = 0;  ///< slope of the surfaces as a share of the edge
};

/// What stands for a pixel along one line, by the steadiest pair of surfaces.
void repair_along(const Values& values, int x, int y, Step step, std::optional<Repair>& best) {
    const glm::dvec3 value = values.at(x, y);
    const Step back{-step.x, -step.y};
    for (int before = 1; before <= kMostMixed_px; ++before) {
        const auto a = side_of(values, x, y, back, before);
        for (int after = 1; a && before + after <= kMostMixed_px + 1; ++after) {
            const auto b = side_of(values, x, y, step, after);
            if (!b || !is_edge(*a, *b, kEdge)) continue;
            const auto share = share_of(value, *a, *b);
            const glm::dvec3 jump = b->value - a->value;
            if (!share || !rises(values, x, y, step, -before, after, jump)) continue;
            const double unsteadiness = (a->slope + b->slope) / glm::length(jump);
            if (!best || unsteadiness < best->unsteadiness)
                best = Repair{*share < 0.5 ? a->value : b->value, unsteadiness};
        }
    }
}

/// A pixel is a mixture for sure with this share of either surface at least.
constexpr double kClearlyMixed = 0.05;

/// Whether an edge may begin between two neighbours: a quick look, for most pixels are inside a surface.
bool may_be_edge(float here, float next) {
    return std::abs(next - here) >
           kClearlyMixed * kSureEdge.least_jump * std::min(std::abs(here), std::abs(next));
}

/// The edge that begins after a pixel, if one does.
void count_edge(const Values& values, int x, int y, Step step, DepthEdges& edges) {
    const auto a = side_of(values, x + step.x, y + step.y, {-step.x, -step.y}, 1);
    for (int mixed = 0; a && mixed <= 2; ++mixed) {
        const int first_x = x + step.x, first_y = y + step.y;
        const auto b = side_of(values, first_x, first_y, step, mixed);
        if (!b || !is_edge(*a, *b, kSureEdge)) continue;
        const glm::dvec3 jump = b->value - a->value;
        bool are_mixed = rises(values, x, y, step, 0, mixed + 1, jump);
        for (int i = 1; i <= mixed; ++i) {
            const auto share = share_of(values.at(x + i * step.x, y + i * step.y), *a, *b);
            are_mixed = are_mixed && share && *share > kClearlyMixed && *share < 1 - kClearlyMixed;
        }
        if (!are_mixed) continue;
        ++(mixed == 0 ? edges.sharp : edges.mixed);
        return;
    }
}

}  // namespace

std::size_t repair_means(Image& image) {
    const Image stored = image;
    const Values values(stored);
    std::size_t repaired = 0;
    for (int y = 0; y < stored.height(); ++y)
        for (int x = 0; x < stored.width(); ++x) {
            std::optional<Repair> repair;
            if (is_finite(values.at(x, y)))
                for (const Step line : kLines) repair_along(values, x, y, line, repair);
            if (!repair) continue;
            for (int c = 0; c < std::min(stored.channels(), 3); ++c)
                image.at(x, y, c) = float(repair->value[c]);
            ++repaired;
        }
    return repaired;
}

bool DepthEdges::are_of_means() const {
    constexpr std::size_t kLeastEdges = 200;
    return sharp + mixed >= kLeastEdges && mixed >= 3 * sharp;
}

DepthEdges find_depth_edges(const Image& depth) {
    const Values values(depth);
    DepthEdges edges;
    for (int y = 0; y < depth.height(); ++y)
        for (int x = 0; x < depth.width(); ++x)
            for (const Step step : {Step{1, 0}, Step{0, 1}})
                if (values.has(x + step.x, y + step.y) &&
                    may_be_edge(depth.at(x, y, 0), depth.at(x + step.x, y + step.y, 0)))
                    count_edge(values, x, y, step, edges);
    return edges;
}

}  // namespace aftershade
