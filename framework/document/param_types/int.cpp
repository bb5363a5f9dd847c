#include <cmath>

#include "framework/document/param_types/numbers.h"
#include "framework/document/units.h"

namespace aftershade {

namespace int_type {

std::optional<ParamValue> parse(const ValueReader& reader, const Node& node) {
    const auto value = reader.scalar(node);
    if (!value) return std::nullopt;
    if (*value != std::floor(*value))
        return reader.fault(node, format_number(*value) + " is not a whole number");
    if (std::abs(*value) > 2147483647.0)
        return reader.fault(node, format_number(*value) + " does not fit 32 bits");
    return std::int64_t(*value);
}

std::vector<double> numbers(const ParamSpec&, const ParamValue& value) {
    return {double(std::get<std::int64_t>(value))};
}

ParamValue of_numbers(const ParamSpec&, const std::vector<double>& numbers) {
    return std::int64_t(std::llround(numbers.at(0)));
}

constexpr ParamTypeTraits type() {
    ParamTypeTraits traits = number_traits("int", 1, "int");
    traits.is_integer = true;
    traits.is_scalar = true;
    traits.is_continuous = false;
    traits.parse = parse;
    traits.schema = quantity_schema;
    traits.numbers = numbers;
    traits.of_numbers = of_numbers;
    return traits;
}

}  // namespace int_type

constinit const ParamTypeTraits kIntParam = int_type::type();

}  // namespace aftershade
