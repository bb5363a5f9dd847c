// float and angle: one number; an angle has a unit without being asked.
#include "framework/document/param_types/numbers.h"

namespace aftershade {

namespace float_type {

std::optional<ParamValue> parse(const ValueReader& reader, const Node& node) {
    const auto value = reader.scalar(node);
    return value ? std::optional<ParamValue>(*value) : std::nullopt;
}

std::vector<double> numbers(const ParamSpec&, const ParamValue& value) {
    return {std::get<double>(value)};
}

ParamValue of_numbers(const ParamSpec&, const std::vector<double>& numbers) {
    return numbers.at(0);
}

constexpr ParamTypeTraits type(std::string_view name, std::string_view usual_unit) {
    ParamTypeTraits traits = number_traits(name, 1, "float");
    traits.is_scalar = true;
    traits.usual_unit = usual_unit;
    traits.parse = parse;
    traits.schema = quantity_schema;
    traits.numbers = numbers;
    traits.of_numbers = of_numbers;
    return traits;
}

}  // namespace float_type

constinit const ParamTypeTraits kFloatParam = float_type::type("float", "");
constinit const ParamTypeTraits kAngleParam = float_type::type("angle", "deg");

}  // namespace aftershade
