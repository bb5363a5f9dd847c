#include "framework/inspect/depth_kind.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/mat4x4.hpp>
#include <glm/matrix.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

namespace aftershade {

namespace {

constexpr std::size_t kMostSamples = 50000;
constexpr std::size_t kLeastSamples = 64;
constexpr double kFits = 0.01;
constexpr double kClearly = 4;
constexpr double kMostOnEdges = 0.2;  // of the pixels

struct PlacedDepth {
    glm::dvec3 position;
    double depth = 0;
};

std::vector<PlacedDepth> samples_of(const Image& depth, const Image& position) {
    std::vector<PlacedDepth> samples;
    const std::size_t pixels = std::size_t(depth.width()) * std::size_t(depth.height());
    const std::size_t stride = std::max<std::size_t>(1, pixels / kMostSamples);
    for (std::size_t i = 0; i < pixels; i += stride) {
        const int x = int(i % std::size_t(depth.width())), y = int(i / std::size_t(depth.width()));
        const double d = depth.at(x, y, 0);
        const glm::dvec3 p(position.at(x, y, 0), position.at(x, y, 1), position.at(x, y, 2));
        if (!std::isfinite(d) || d <= 0 || !std::isfinite(p.x + p.y + p.z) || p == glm::dvec3(0)) continue;
        samples.push_back({p, d});
    }
    return samples;
}

/// Moves the middle to the origin and makes the spread 1, for the sake of the equations.
void normalize(std::vector<PlacedDepth>& samples) {
    glm::dvec3 middle(0);
    for (const PlacedDepth& one : samples) middle += one.position / double(samples.size());
    double spread = 0;
    for (PlacedDepth& one : samples) {
        one.position -= middle;
        spread += glm::dot(one.position, one.position) / double(samples.size());
    }
    const double scale = spread > 0 ? 1 / std::sqrt(spread) : 1;
    for (PlacedDepth& one : samples) {
        one.position *= scale;
        one.depth *= scale;
    }
}

/// a and b of value = a . position + b, by least squares; positions in one plane leave a free along its
/// normal, where it becomes 0.
template <class ValueOf>
glm::dvec4 affine_fit(const std::vector<PlacedDepth>& samples, ValueOf&& value_of) {
    constexpr double kRidge = 1e-9;
    glm::dmat4 normal(kRidge * double(samples.size()));
    glm::dvec4 right(0);
    for (const PlacedDepth& one : samples) {
        const glm::dvec4 row(one.position, 1);
        normal += glm::outerProduct(row, row);
        right += row * value_of(one);
    }
    return glm::inverse(normal) * right;
}

double root_mean_square(const std::vector<double>& errors) {
    double sum = 0;
    for (const double error : errors) sum += error * error;
    return std::sqrt(sum / double(errors.size()));
}

}  // namespace

DepthKind::Verdict DepthKind::verdict() const {
    if (pixels == 0) return Verdict::unknown;
    if (planar_error <= kFits && kClearly * planar_error <= radial_error) return Verdict::planar;
    if (radial_error <= kFits && kClearly * radial_error <= planar_error) return Verdict::radial;
    return Verdict::unknown;
}

bool DepthKind::contradicts() const {
    return pixels > 0 && std::min(planar_error, radial_error) > kFits &&
           std::min(planar_off, radial_off) > kMostOnEdges;
}

std::string DepthKind::text() const {
    switch (verdict()) {
        case Verdict::planar: return fmt::format("planar, fits position to {:.2g} %", 100 * planar_error);
        case Verdict::radial: return fmt::format("radial, fits position to {:.2g} %", 100 * radial_error);
        case Verdict::unknown: break;
    }
    return "";
}

DepthKind find_depth_kind(const Image& depth, const Image& position) {
    DepthKind kind;
    std::vector<PlacedDepth> samples = samples_of(depth, position);
    if (samples.size() < kLeastSamples) return kind;
    normalize(samples);
    kind.pixels = samples.size();
    std::vector<double> depths;
    for (const PlacedDepth& one : samples) depths.push_back(one.depth);
    std::nth_element(depths.begin(), depths.begin() + std::ptrdiff_t(depths.size() / 2), depths.end());
    const double median = depths[depths.size() / 2];

    const glm::dvec4 plane = affine_fit(samples, [](const PlacedDepth& one) { return one.depth; });
    // |p - c|^2 = |p|^2 - 2 c . p + |c|^2: what is left without |p|^2 is affine in p.
    const glm::dvec4 sphere = affine_fit(samples, [](const PlacedDepth& one) {
        return one.depth * one.depth - glm::dot(one.position, one.position);
    });
    std::vector<double> planar, radial;
    for (const PlacedDepth& one : samples) {
        const glm::dvec4 row(one.position, 1);
        planar.push_back(glm::dot(plane, row) - one.depth);
        radial.push_back(
            std::sqrt(std::max(0.0, glm::dot(one.position, one.position) + glm::dot(sphere, row))) -
            one.depth);
    }
    kind.planar_error = root_mean_square(planar) / median;
    kind.radial_error = root_mean_square(radial) / median;
    const auto off_share = [&](const std::vector<double>& errors) {
        const auto off =
            std::ranges::count_if(errors, [&](double error) { return std::abs(error) > kFits * median; });
        return double(off) / double(errors.size());
    };
    kind.planar_off = off_share(planar);
    kind.radial_off = off_share(radial);
    return kind;
}

}  // namespace aftershade
