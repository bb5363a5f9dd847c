// color, vec2, vec3 and vec4: some numbers of one unit and one range.
#include "framework/document/param_types/numbers.h"
#include "framework/document/schema_pieces.h"

namespace aftershade {

namespace vector_type {

std::optional<ParamValue> parse(const ValueReader& reader, const Node& node) {
    const std::size_t count = std::size_t(component_count(reader.spec.type));
    if (!node.is_array() || node.items.size() != count)
        return reader.fault(node, "expected an array of " + std::to_string(count) + " numbers");
    std::vector<double> values;
    for (const Node& item : node.items)
        if (const auto value = reader.scalar(item)) values.push_back(*value);
    if (values.size() != count) return std::nullopt;
    return values;
}

schema::json literal(const ParamSpec& spec, const schema::LiteralParts& parts) {
    ParamSpec component = spec;
    component.type = ParamType::float_;
    const int count = component_count(spec.type);
    return schema::array_of(parts.part(schema::quantity(component)), count, count);
}

std::vector<double> numbers(const ParamSpec&, const ParamValue& value) {
    return std::get<std::vector<double>>(value);
}

ParamValue of_numbers(const ParamSpec&, const std::vector<double>& numbers) {
    return numbers;
}

constexpr ParamTypeTraits type(std::string_view name, int components, std::string_view glsl_type) {
    ParamTypeTraits traits = number_traits(name, components, glsl_type);
    traits.parse = parse;
    traits.schema = literal;
    traits.numbers = numbers;
    traits.of_numbers = of_numbers;
    return traits;
}

}  // namespace vector_type

constinit const ParamTypeTraits kColorParam = vector_type::type("color", 3, "vec3");
constinit const ParamTypeTraits kVec2Param = vector_type::type("vec2", 2, "vec2");
constinit const ParamTypeTraits kVec3Param = vector_type::type("vec3", 3, "vec3");
constinit const ParamTypeTraits kVec4Param = vector_type::type("vec4", 4, "vec4");

}  // namespace aftershade
