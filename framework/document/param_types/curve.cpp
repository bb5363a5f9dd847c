// A function of one variable; shaders read its samples from a texture.
#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>

#include "framework/document/glsl_text.h"
#include "framework/document/grammar.h"
#include "framework/document/param_type.h"
#include "framework/document/param_types/curve.h"
#include "framework/document/schema_pieces.h"
#include "framework/document/units.h"

namespace aftershade {

namespace curve_type {

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

}  // namespace curve_type

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
    const std::vector<double> slopes = curve_type::monotone_slopes(points);
    return curve_type::hermite(a, b, slopes[i], slopes[i + 1], x);
}

namespace curve_type {

constexpr const char* kDomainFault = "'domain' holds two numbers that rise, the ends of x";

constexpr std::string_view kCurve = R"(layout(binding = $binding) uniform sampler2D $texture;
float $name(float x) {
    float at = clamp((x - $low) * $scale, 0.0, $last);
    int i = min(int(at), int($last) - 1);
    float a = texelFetch($texture, ivec2(i, 0), 0).r;
    float b = texelFetch($texture, ivec2(i + 1, 0), 0).r;
    return mix(a, b, at - float(i));
}
)";

class CurveTexture final : public AbstractParamTexture {
public:
    TexelSize size(const ParamValue&) const override { return {kCurveSamples, 1, 1}; }

    std::vector<float> texels(const ParamSpec& spec, const ParamValue& value) const override {
        const auto& curve = std::get<CurveValue>(value);
        std::vector<float> samples;
        for (int i = 0; i < kCurveSamples; ++i)
            samples.push_back(
                float(curve.at(std::lerp(spec.domain[0], spec.domain[1], double(i) / (kCurveSamples - 1)))));
        return samples;
    }

    std::string glsl(const ParamSpec& spec, int binding) const override {
        const auto [low, high] = spec.domain;
        return filled(kCurve, {{"name", spec.name},
                               {"texture", spec.name + "_curve"},
                               {"binding", std::to_string(binding)},
                               {"low", glsl_float(low)},
                               {"scale", glsl_float((kCurveSamples - 1) / (high - low))},
                               {"last", glsl_float(kCurveSamples - 1)}});
    }
};

constexpr CurveTexture kTexture;

class CurveType final : public AbstractParamType {
public:
    constexpr CurveType()
        : AbstractParamType(
              {.name = "curve", .home = ParamHome::resource, .has_range = true, .texture = &kTexture}) {}

    std::optional<ParamValue> parse(const ValueReader& value_reader, const Node& node) const override {
        const auto& [spec, label, diagnostics] = value_reader;
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
            return value_reader.wrong_kind(
                node, "points, [[x, y], ...], or an object with 'points' and 'interpolation'");
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

    void declare(grammar::Block& declaration, const grammar::Block&) const override {
        declaration.keys.push_back(grammar::optional(
            "domain", grammar::list(grammar::number(), {.min = 2, .max = 2, .fault = kDomainFault}),
            "Range of x.", "[0, 1]"));
    }

    void read_declaration(const SpecReader& reader, ParamSpec& spec) const override {
        const Node* domain = reader.node.find("domain");
        if (!domain) return;
        spec.domain = {domain->items[0].number, domain->items[1].number};
        if (spec.domain[0] >= spec.domain[1]) reader.diagnostics.error(domain->place, kDomainFault);
    }

    schema::json literal_schema(const ParamSpec& spec, const schema::LiteralParts& parts) const override {
        const schema::json x = {{"type", "number"}, {"minimum", spec.domain[0]}, {"maximum", spec.domain[1]}};
        ParamSpec y = spec;
        y.type = ParamType::float_;
        const schema::json point = {{"type", "array"},
                                    {"prefixItems", {parts.part(x), parts.part(schema::quantity(y))}},
                                    {"minItems", 2},
                                    {"maxItems", 2}};
        const schema::json points = schema::array_of(parts.part(point), 1, int(kMaxCurvePoints));
        const schema::json interpolation = parts.part(schema::one_of({"linear", "smooth"}));
        return schema::any_of(
            {points,
             schema::object({{"points", parts.part(points)}, {"interpolation", interpolation}}, {"points"})});
    }

    schema::json describe(const ParamSpec& spec) const override { return {{"domain", spec.domain}}; }

    ParamValue scale(const ParamSpec& spec, const ParamValue& value, double factor) const override {
        CurveValue curve = std::get<CurveValue>(value);
        if (spec.unit == "px")
            for (auto& point : curve.points) point[1] = scaled_px(spec, point[1], factor);
        return curve;
    }
};

constexpr CurveType kType;

}  // namespace curve_type

constinit const ParamType ParamType::curve{curve_type::kType};

}  // namespace aftershade
