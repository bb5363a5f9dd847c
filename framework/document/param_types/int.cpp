#include <cmath>

#include "framework/document/param_types/numbers.h"
#include "framework/document/schema_pieces.h"
#include "framework/document/units.h"

namespace aftershade {

namespace int_type {

class IntType final : public AbstractParamType {
public:
    constexpr IntType() : AbstractParamType(number_traits("int", 1, "int")) {
        is_integer = true;
        is_continuous = false;
    }

    std::optional<ParamValue> parse(const ValueReader& reader, const Node& node) const override {
        const auto value = reader.scalar(node);
        if (!value) return std::nullopt;
        if (*value != std::floor(*value))
            return reader.fault(node, format_number(*value) + " is not a whole number");
        if (std::abs(*value) > 2147483647.0)
            return reader.fault(node, format_number(*value) + " does not fit 32 bits");
        return std::int64_t(*value);
    }

    schema::json literal_schema(const ParamSpec& spec, const schema::LiteralParts&) const override {
        return schema::quantity(spec);
    }

    std::vector<double> numbers(const ParamSpec&, const ParamValue& value) const override {
        return {double(std::get<std::int64_t>(value))};
    }

    ParamValue of_numbers(const ParamSpec&, const std::vector<double>& numbers) const override {
        return std::int64_t(std::llround(numbers.at(0)));
    }
};

constexpr IntType kType;

}  // namespace int_type

constinit const ParamType ParamType::int_{int_type::kType};

}  // namespace aftershade
