// float and angle: one number; an angle has a unit without being asked.
#include "framework/document/param_types/numbers.h"
#include "framework/document/schema_pieces.h"

namespace aftershade {

namespace float_type {

class FloatType final : public AbstractParamType {
public:
    constexpr FloatType(std::string_view name_of_type, std::string_view unit)
        : AbstractParamType(number_traits(name_of_type, 1, "float")) {
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

constexpr FloatType kFloat("float", ""), kAngle("angle", "deg");

}  // namespace float_type

constinit const ParamType ParamType::float_{float_type::kFloat};
constinit const ParamType ParamType::angle{float_type::kAngle};

}  // namespace aftershade
