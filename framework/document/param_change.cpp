// Values between two others, and values for images of another size.
#include <algorithm>
#include <cmath>

#include "framework/document/param_type.h"

namespace aftershade {

double scaled_px(const ParamSpec& spec, double number, double factor) {
    if (!spec.type->is_integer) return number * factor;
    const double rounded = std::clamp(std::round(number * factor), -2147483647.0, 2147483647.0);
    return spec.min ? std::max(rounded, std::ceil(*spec.min)) : rounded;
}

ParamValue interpolate(const ParamSpec& spec, const ParamValue& a, const ParamValue& b, double t) {
    if (!spec.type->is_continuous) return t < 1 ? a : b;
    std::vector<double> numbers = numbers_of(spec, a);
    const std::vector<double> ends = numbers_of(spec, b);
    for (std::size_t i = 0; i < numbers.size(); ++i) numbers[i] = std::lerp(numbers[i], ends[i], t);
    return value_of_numbers(spec, numbers);
}

ParamValue scale_pixels(const ParamSpec& spec, const ParamValue& value, double factor) {
    return spec.type->scale(spec, value, factor);
}

ParamValue AbstractParamType::scale(const ParamSpec& spec, const ParamValue& value, double factor) const {
    if (spec.unit != "px" || !is_block_type(spec.type)) return value;
    std::vector<double> numbers = numbers_of(spec, value);
    for (double& number : numbers) number = scaled_px(spec, number, factor);
    return value_of_numbers(spec, numbers);
}

}  // namespace aftershade
