// Where the names of a file's channels alone decide what a role is: what else they may mean.
#include <algorithm>
#include <cmath>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <glm/vec3.hpp>

#include "framework/base/error.h"
#include "framework/capture/capture_grammar.h"
#include "framework/capture/capture_internal.h"
#include "framework/capture/channel_names.h"
#include "framework/capture/common_data.h"
#include "framework/capture/common_names.h"
#include "framework/image/image.h"
#include "framework/image/role.h"

namespace aftershade {

namespace {

// Whether a depth has the unit of the positions beside it.

struct Point {
    glm::dvec3 position;
    double depth = 0;
};

/// Some thousand of them, spread over the picture.
std::vector<Point> points_of(const Image& depth, const Image& position) {
    constexpr int kMostOfASide = 64;
    const int step = std::max({depth.width() / kMostOfASide, depth.height() / kMostOfASide, 1});
    std::vector<Point> points;
    for (int y = 0; y < depth.height(); y += step)
        for (int x = 0; x < depth.width(); x += step) {
            const Point point{{position.at(x, y, 0), position.at(x, y, 1), position.at(x, y, 2)},
                              double(depth.at(x, y, 0))};
            if (std::isfinite(point.depth) && std::isfinite(glm::dot(point.position, point.position)))
                points.push_back(point);
        }
    return points;
}

/// Whether the depth is a distance along one axis in the positions' unit: an affine function of them whose
/// gradient is 1 long. False where the positions lie in a plane. Both over one grid. [thread-safe]
bool is_distance_of(const Image& depth, const Image& position) {
    constexpr double kPlane = 1e-6, kGradient = 0.02, kResidual = 1e-3;
    std::vector<Point> points = points_of(depth, position);
    Point mean{};
    for (const Point& point : points) mean.position += point.position, mean.depth += point.depth;
    mean.position /= double(points.size()), mean.depth /= double(points.size());
    glm::dmat3 covariance(0);
    glm::dvec3 with_depth(0);
    double variance = 0, spread = 0;
    for (Point& point : points) {
        point.position -= mean.position, point.depth -= mean.depth;
        covariance += glm::outerProduct(point.position, point.position);
        with_depth += point.depth * point.position;
        variance += point.depth * point.depth;
        spread += glm::dot(point.position, point.position);
    }
    if (!(spread > 0) || !(glm::determinant(covariance) > kPlane * spread * spread * spread)) return false;
    const glm::dvec3 gradient = glm::inverse(covariance) * with_depth;
    double residual = 0;
    for (const Point& point : points)
        residual += std::pow(glm::dot(gradient, point.position) - point.depth, 2);
    return residual <= kResidual * variance && std::abs(glm::length(gradient) - 1) < kGradient;
}

/// Copies of one pass, of which one may be stored as half.
bool are_alike(float a, float b) {
    constexpr float kHalf = 1e-3f, kLargestHalf = 65504;
    if (a == b || (std::isnan(a) && std::isnan(b)) || (a >= kLargestHalf && b >= kLargestHalf)) return true;
    return std::abs(a - b) <= kHalf * std::max(std::abs(a), std::abs(b));
}

/// By the channels that both have.
bool are_alike(const Image& a, const Image& b) {
    if (a.type() == ComponentType::uint32) return std::ranges::equal(a.uints(), b.uints());
    for (int y = 0; y < a.height(); ++y)
        for (int x = 0; x < a.width(); ++x)
            for (int c = 0; c < std::min(a.channels(), b.channels()); ++c)
                if (!are_alike(a.at(x, y, c), b.at(x, y, c))) return false;
    return true;
}

std::string first_of(const FoundChannels& found) {
    return found.front().front();
}

}  // namespace

/// Neither the user nor a producer's documentation says which channels the role has.
bool CaptureReader::is_guessed(const OpenFrame& open, const std::string& role) const {
    return sequence_.profile == "auto" && open.profile->id == "native" &&
           !sequence_.channels.contains(role) && open.header.metadata.text("aftershade/channels") != "native";
}

void CaptureReader::find_others(OpenFrame& open, const std::string& role, RoleSource& source) const {
    if (!is_guessed(open, role) || source.channels.empty()) return;
    const ExrPart& part = source.file->merged();
    const bool is_main = source.file == open.main.get();
    const auto color = open.header.role_channels.find(kColorRole);
    const std::string red = color == open.header.role_channels.end() ? "" : color->second.front();
    source.others = role != kColorRole ? find_all_common_data(part, role, is_main ? open.header.layer : "",
                                                              is_main ? red : "")
                    : open.header.layer.empty() ? find_all_common_colors(part)
                                                : std::vector<FoundChannels>{};
    std::erase_if(source.others, [&](const FoundChannels& other) {
        return first_of(other) == first_of(source.channels) || source.file->deep_part_of(first_of(other));
    });
    for (const FoundChannels& other : source.others)
        open.header.other_channels[role].push_back(first_of(other));
}

/// Only where they hold something else.
void CaptureReader::warn_of_others(const OpenFrame& open, const std::string& role, const Image& stored,
                                   Capture& capture) const {
    const RoleSource& source = open.roles.at(role);
    if (open.layer >= 0 || (!source.others.empty() && source.file->deep_part_of(first_of(source.channels))))
        return;
    std::vector<std::string> different;
    for (const FoundChannels& channels : source.others) {
        RoleSource other = source;
        other.channels = channels;
        try {
            const Window& grid = open.header.data_window;
            const bool is_equal = stored.type() == ComponentType::uint32
                                      ? are_alike(stored, read_ids(other, grid))
                                      : are_alike(stored, source.file->read_floats(channels[0], grid,
                                                                                   find_role(role)->outside));
            if (is_equal) continue;
        } catch (const Error&) {
            // No number of an object: something else under the role's name.
        }
        different.push_back(first_of(channels));
    }
    if (different.empty()) return;
    std::string names;
    for (const std::string& name : source.channels[0])
        if (!name.empty()) names += (names.empty() ? "\"" : ", \"") + name + "\"";
    capture.header.warnings.push_back(
        role + " is read from '" + first_of(source.channels) + "', and " + list_of_names(different, "and") +
        (different.size() == 1 ? " goes by its name and holds" : " go by its name and hold") +
        " other values (say which is meant: \"channels\": {\"" + role + "\": {\"channels\": [" + names +
        "]}} in capture.json)");
}

/// A depth between 0 and 1 throughout is seldom one in metres.
bool CaptureReader::is_unit_in_doubt(const OpenFrame& open, const std::string& role,
                                     const Image& stored) const {
    if (kind_of_role(role) != RoleKind::distance || open.layer >= 0 || !is_guessed(open, role)) return false;
    float least = 2, most = -1;
    for (const float z : stored.floats()) {
        if (!std::isfinite(z)) continue;
        if (z < 0 || z > 1) return false;
        least = std::min(least, z), most = std::max(most, z);
    }
    return least < most;
}

void CaptureReader::warn_of_unit(const OpenFrame& open, const std::string& role, const Image& stored,
                                 Capture& capture) const {
    const auto far_m = open.header.camera.get("far");
    if (far_m && *far_m <= 1) return;
    for (const auto& [other, source] : open.roles)
        if (kind_of_role(other) == RoleKind::place &&
            is_distance_of(stored, read_role(open, other, nullptr, capture)))
            return;
    capture.header.warnings.push_back(role + " is read from '" + first_of(open.roles.at(role).channels) +
                                      "' as metres, and lies between 0 and 1 everywhere, as a normalized "
                                      "depth or a z-buffer does (say what "
                                      "it is: \"channels\": {\"" +
                                      role + "\": {\"channels\": [\"" +
                                      first_of(open.roles.at(role).channels) +
                                      "\"], \"encoding\": ...}} in capture.json, \"linear\" for metres, "
                                      "\"normalized\" or \"z_buffer\" with "
                                      "near and far of its camera)");
}

}  // namespace aftershade
