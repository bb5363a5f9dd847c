#include "framework/core/param_internal.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>

namespace aftershade {

namespace {

using Points = std::vector<std::array<double, 2>>;

/// dy/dx at each point, so that the Hermite cubics between them are monotone where the points are: Fritsch
/// and Carlson 1980, "Monotone Piecewise Cubic Interpolation", doi:10.1137/0717021, with the circle of radius
/// 3 as the region of monotonicity.
std::vector<double> monotone_slopes(const Points& points) {
    const std::size_t last = points.size() - 1;
    std::vector<double> secants(last);
    for (std::size_t i = 0; i < last; ++i)
        secants[i] = (points[i + 1][1] - points[i][1]) / (points[i + 1][0] - points[i][0]);
    std::vector<double> slopes(points.size());
    slopes[0] = secants[0];
    slopes[last] = secants[last - 1];
    for (std::size_t i = 1; i < last; ++i) {
        const bool turns = secants[i - 1] * secants[i] <= 0;
        slopes[i] = turns ? 0.0 : (secants[i - 1] + secants[i]) / 2;
    }
    for (std::size_t i = 0; i < last; ++i) {
        if (secants[i] == 0) {
            slopes[i] = slopes[i + 1] = 0;
            continue;
        }
        const double length = std::hypot(slopes[i], slopes[i + 1]) / std::abs(secants[i]);
        if (length <= 3) continue;
        slopes[i] *= 3 / length;
        slopes[i + 1] *= 3 / length;
    }
    return slopes;
}

double hermite(const std::array<double, 2>& a, const std::array<double, 2>& b, double slope_a, double slope_b,
               double x) {
    const double width = b[0] - a[0];
    const double t = (x - a[0]) / width;
    const double s = 1 - t;
    const double y =
        s * s * (1 + 2 * t) * a[1] + t * t * (1 + 2 * s) * b[1] + width * s * t * (s * slope_a - t * slope_b);
    // Rounding alone can leave the range of the two points.
    return std::clamp(y, std::min(a[1], b[1]), std::max(a[1], b[1]));
}

CurveValue::Interpolation read_interpolation(ObjectReader& reader) {
    static const std::vector<std::string> names = {"linear", "smooth"};
    const auto name = reader.choice("interpolation", names);
    return name == "smooth" ? CurveValue::Interpolation::smooth : CurveValue::Interpolation::linear;
}

/// One point; nullopt after a fault.
std::optional<std::array<double, 2>> read_point(const ValueReader& reader, const Node& node) {
    if (!node.is_array() || node.items.size() != 2 || !node.items[0].is_number())
        return reader.fault(node, "expected a point, [x, y]");
    const double x = node.items[0].number;
    const auto& [low, high] = reader.spec.domain;
    if (x < low || x > high)
        return reader.fault(node.items[0], "x " + format_number(x) + " lies outside the domain, " +
                                               format_number(low) + " to " + format_number(high));
    const auto y = reader.scalar(node.items[1]);
    if (!y) return std::nullopt;
    return std::array<double, 2>{x, *y};
}

}  // namespace

double CurveValue::at(double x) const {
    assert(!points.empty());
    if (!(x > points.front()[0])) return points.front()[1];
    if (x >= points.back()[0]) return points.back()[1];
    const auto above = std::upper_bound(points.begin(), points.end(), x,
                                        [](double value, const auto& point) { return value < point[0]; });
    const std::size_t i = std::size_t(above - points.begin()) - 1;
    const auto& a = points[i];
    const auto& b = points[i + 1];
    if (interpolation == Interpolation::linear) return std::lerp(a[1], b[1], (x - a[0]) / (b[0] - a[0]));
    const std::vector<double> slopes = monotone_slopes(points);
    return hermite(a, b, slopes[i], slopes[i + 1], x);
}

std::optional<ParamValue> ValueReader::curve(const Node& node) const {
    CurveValue value;
    const int errors_before = diagnostics.error_count();
    const Node* points = &node;
    std::string points_label = label;
    if (node.is_object()) {
        ObjectReader reader(node, label, diagnostics);
        value.interpolation = read_interpolation(reader);
        points = reader.array("points", ObjectReader::Presence::required);
        reader.finish();
        points_label += ".points";
    } else if (!node.is_array()) {
        return wrong_kind(node, "points, [[x, y], ...], or an object with 'points' and 'interpolation'");
    }
    if (!points) return std::nullopt;
    const std::size_t count = points->items.size();
    if (count < 1 || count > kMaxCurvePoints)
        return ValueReader{spec, points_label, diagnostics}.fault(
            *points,
            std::to_string(count) + " points; a curve has from 1 to " + std::to_string(kMaxCurvePoints));
    for (std::size_t i = 0; i < count; ++i) {
        const ValueReader reader{spec, points_label + "[" + std::to_string(i) + "]", diagnostics};
        const auto point = read_point(reader, points->items[i]);
        if (!point) continue;
        if (!value.points.empty() && (*point)[0] <= value.points.back()[0])
            reader.fault(points->items[i], "x " + format_number((*point)[0]) +
                                               " must lie above the x of the point before, " +
                                               format_number(value.points.back()[0]));
        value.points.push_back(*point);
    }
    if (diagnostics.error_count() > errors_before) return std::nullopt;
    return value;
}

}  // namespace aftershade
