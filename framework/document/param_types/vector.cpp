// color, vec2, vec3 and vec4: some numbers of one unit and one range.
#include "framework/document/param_types/numbers.h"
#include "framework/document/schema_pieces.h"

namespace aftershade {

namespace vector_type {

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

constexpr VectorType kColor("color", 3, "vec3"), kVec2("vec2", 2, "vec2"), kVec3("vec3", 3, "vec3"),
    kVec4("vec4", 4, "vec4");

}  // namespace vector_type

constinit const ParamType ParamType::color{vector_type::kColor};
constinit const ParamType ParamType::vec2{vector_type::kVec2};
constinit const ParamType ParamType::vec3{vector_type::kVec3};
constinit const ParamType ParamType::vec4{vector_type::kVec4};

}  // namespace aftershade
