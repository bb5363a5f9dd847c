#include "framework/capture/depth_unit.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <glm/vec3.hpp>

namespace aftershade {

namespace {

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

}  // namespace

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

}  // namespace aftershade
