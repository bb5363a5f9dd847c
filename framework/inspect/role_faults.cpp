#include "framework/inspect/role_faults.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include <fmt/format.h>

#include "framework/inspect/depth_kind.h"

namespace aftershade {

namespace {

constexpr std::size_t kLeastPixels = 64;
constexpr double kLengthSlack = 0.02;  // half floats and rounding to bytes change a length by less
constexpr double kMostlyTrue = 0.9;    // of the pixels; the rest may lie on edges
constexpr double kDepthSlack = 0.02;   // of the depth

Image upside_down(const Image& image) {
    Image turned(image.width(), image.height(), image.channels());
    for (int y = 0; y < image.height(); ++y)
        for (int x = 0; x < image.width(); ++x)
            for (int c = 0; c < image.channels(); ++c)
                turned.at(x, y, c) = image.at(x, image.height() - 1 - y, c);
    return turned;
}

double median_of(std::vector<double>& values) {
    const auto middle = values.begin() + std::ptrdiff_t(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

/// The share of the pixels with a depth or a position that have both.
double overlap(const Image& depth, const Image& position) {
    std::size_t both = 0, either = 0;
    for (int y = 0; y < depth.height(); ++y)
        for (int x = 0; x < depth.width(); ++x) {
            const bool has_depth = std::isfinite(depth.at(x, y, 0)) && depth.at(x, y, 0) > 0;
            const bool has_position =
                position.at(x, y, 0) != 0 || position.at(x, y, 1) != 0 || position.at(x, y, 2) != 0;
            both += has_depth && has_position;
            either += has_depth || has_position;
        }
    return either < kLeastPixels ? 1 : double(both) / double(either);
}

/// The median ratio of the distances along the camera's axis to the depths; 1 where they agree or too few are
/// known.
double ratio_to_camera(const Image& depth, const Image& position, const CameraMatrix& camera_from_world) {
    std::vector<double> ratios;
    const auto& m = camera_from_world;
    for (int y = 0; y < depth.height(); ++y)
        for (int x = 0; x < depth.width(); ++x) {
            const double d = double(depth.at(x, y, 0));
            const double px = double(position.at(x, y, 0)), py = double(position.at(x, y, 1)),
                         pz = double(position.at(x, y, 2));
            const bool is_hit =
                std::isfinite(d) && d > 0 && std::isfinite(px + py + pz) && (px != 0 || py != 0 || pz != 0);
            // View space looks along -z.
            if (is_hit) ratios.push_back(-(m[8] * px + m[9] * py + m[10] * pz + m[11]) / d);
        }
    return ratios.size() < kLeastPixels ? 1 : median_of(ratios);
}

}  // namespace

std::string find_position_fault(const Image& depth, const Image& position, const Camera& camera) {
    const DepthKind kind = find_depth_kind(depth, position);
    if (kind.verdict() == DepthKind::Verdict::unknown) {
        const bool covers_others = overlap(depth, position) < 0.5;
        if (!kind.contradicts() && !covers_others) return "";
        if (covers_others && overlap(upside_down(depth), position) < kMostlyTrue) return "";
        if (covers_others ||
            find_depth_kind(upside_down(depth), position).verdict() != DepthKind::Verdict::unknown)
            return "the depth is upside down against the position: with its rows in the other order it fits; "
                   "write both from the same corner of the picture";
        return fmt::format(
            "the depth contradicts the position: read as planar it is {:.2g} % off, as radial "
            "{:.2g} %; check the depth's encoding, unit and channel",
            100 * kind.planar_error, 100 * kind.radial_error);
    }
    if (!camera.camera_from_world || kind.verdict() != DepthKind::Verdict::planar) return "";
    const double ratio = ratio_to_camera(depth, position, *camera.camera_from_world);
    if (std::abs(ratio - 1) <= kDepthSlack) return "";
    return fmt::format(
        "depth and position fit each other, but not the camera's matrices: by these the pixels are "
        "{:.4g} times as far away (median); check the space of the positions and the matrices",
        ratio);
}

std::string find_normal_fault(const Image& normal) {
    std::vector<double> lengths;
    std::size_t packed = 0, negative = 0;
    for (int y = 0; y < normal.height(); ++y)
        for (int x = 0; x < normal.width(); ++x) {
            const double n[3] = {double(normal.at(x, y, 0)), double(normal.at(x, y, 1)),
                                 double(normal.at(x, y, 2))};
            const double length = std::hypot(n[0], n[1], n[2]);
            if (!std::isfinite(length) || length == 0) continue;
            lengths.push_back(length);
            negative += n[0] < 0 || n[1] < 0 || n[2] < 0;
            packed += std::abs(std::hypot(2 * n[0] - 1, 2 * n[1] - 1, 2 * n[2] - 1) - 1) <= kLengthSlack;
        }
    if (lengths.size() < kLeastPixels) return "";
    const std::size_t pixels = lengths.size();
    const double median = median_of(lengths);
    if (std::abs(median - 1) <= kLengthSlack) return "";
    if (negative == 0 && double(packed) >= kMostlyTrue * double(pixels))
        return fmt::format(
            "the normals are packed: all components are from 0 to 1, and 2 n - 1 has length 1 in "
            "{} of {} pixels; no setting undoes that, so have the producer write -1 to 1",
            packed, pixels);
    return fmt::format(
        "the normals have length {:.3g} (median of {} pixels), not 1; have the producer write unit "
        "vectors, or check the channels",
        median, pixels);
}

}  // namespace aftershade
