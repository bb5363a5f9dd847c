// float and angle: one number; an angle has a unit without being asked. int: a whole one. color, vec2, vec3
// and vec4: some numbers of one unit and one range.
#include <cmath>
#include <string_view>

#include "framework/document/param_type.h"
#include "framework/document/schema_pieces.h"
#include "framework/document/units.h"

namespace aftershade {

namespace number_types {

/// A block type of numbers with a range, continuous; the rest is the type's own.
constexpr ParamTypeTraits number_traits(std::string_view name, int components, std::string_view glsl_type) {
    ParamTypeTraits traits;
    traits.name = name;
    traits.components = components;
    traits.glsl_type = glsl_type;
    traits.has_range = true;
    traits.is_scalar = components == 1;
    traits.is_continuous = true;
    return traits;
}

class FloatType : public AbstractParamType {
public:
    constexpr FloatType(std::string_view name_of_type, std::string_view unit,
                        std::string_view type_in_glsl = "float")
        : AbstractParamType(number_traits(name_of_type, 1, type_in_glsl)) {
        usual_unit = unit;
    }

    std::optional<ParamValue> parse(const ValueReader& reader, const Node& node) const override {
        const auto value = reader.scalar(node);
        return value ? std::optional<ParamValue>(*value) : std::nullopt;
    }

    schema::json literal_schema(const ParamSpec& spec, const schema::LiteralParts&) const override {
        return schema::quantity(spec);
    }

    std::vector<double> numbers(const ParamSpec&, const ParamValue& value) const override {
        return {std::get<double>(value)};
    }

    ParamValue of_numbers(const ParamSpec&, const std::vector<double>& numbers) const override {
        return numbers.at(0);
    }
};

class IntType final : public FloatType {
public:
    constexpr IntType() : FloatType("int", "", "int") {
        is_integer = true;
        is_continuous = false;
    }

    std::optional<ParamValue> parse(const ValueReader& reader, const Node& node) const override {
        const auto value = reader.scalar(node);
        if (!value) return std::nullopt;
        if (*value != std::floor(*value))
            return reader.fault(node, format_number(*value) + " is not a whole number");
        if (*value < -2147483648.0 || *value > 2147483647.0)
            return reader.fault(node, format_number(*value) + " does not fit 32 bits");
        return std::int64_t(*value);
    }

    std::vector<double> numbers(const ParamSpec&, const ParamValue& value) const override {
        return {double(std::get<std::int64_t>(value))};
    }

    ParamValue of_numbers(const ParamSpec&, const std::vector<double>& numbers) const override {
        return std::int64_t(std::llround(numbers.at(0)));
    }
};

class VectorType final : public AbstractParamType {
public:
    constexpr VectorType(std::string_view name_of_type, int count, std::string_view type_in_glsl)
        : AbstractParamType(number_traits(name_of_type, count, type_in_glsl)) {}

    std::optional<ParamValue> parse(const ValueReader& reader, const Node& node) const override {
        const std::size_t count = std::size_t(components);
        if (!node.is_array() || node.items.size() != count)
            return reader.fault(node, "expected an array of " + std::to_string(count) + " numbers");
        std::vector<double> values;
        for (const Node& item : node.items)
            if (const auto value = reader.scalar(item)) values.push_back(*value);
        if (values.size() != count) return std::nullopt;
        return values;
    }

    schema::json literal_schema(const ParamSpec& spec, const schema::LiteralParts& parts) const override {
        ParamSpec component = spec;
        component.type = ParamType::float_;
        return schema::array_of(parts.part(schema::quantity(component)), components, components);
    }

    std::vector<double> numbers(const ParamSpec&, const ParamValue& value) const override {
        return std::get<std::vector<double>>(value);
    }

    ParamValue of_numbers(const ParamSpec&, const std::vector<double>& numbers) const override {
        return numbers;
    }
};

constexpr FloatType kFloat("float", ""), kAngle("angle", "deg");
constexpr IntType kInt;
constexpr VectorType kColor("color", 3, "vec3"), kVec2("vec2", 2, "vec2"), kVec3("vec3", 3, "vec3"),
    kVec4("vec4", 4, "vec4");

}  // namespace number_types

constinit const ParamType ParamType::float_{number_types::kFloat};
constinit const ParamType ParamType::angle{number_types::kAngle};
constinit const ParamType ParamType::int_{number_types::kInt};
constinit const ParamType ParamType::color{number_types::kColor};
constinit const ParamType ParamType::vec2{number_types::kVec2};
constinit const ParamType ParamType::vec3{number_types::kVec3};
constinit const ParamType ParamType::vec4{number_types::kVec4};

}  // namespace aftershade
