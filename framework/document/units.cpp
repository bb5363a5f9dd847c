#include "framework/document/units.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <numbers>

namespace aftershade {

namespace {

enum class Dimension { length, angle, image_length, time, exposure };

/// One of it is numerator / denominator metres, radians, pixels, seconds or stops. The two stay apart so that
/// "85 mm" in metres is one division, correctly rounded: the double that 0.085 reads as.
struct Unit {
    std::string_view name;
    Dimension dimension;
    double numerator;
    double denominator;
};

constexpr double kPi = std::numbers::pi;
constexpr std::array kUnits = {
    Unit{"um", Dimension::length, 1, 1e6},     Unit{"mm", Dimension::length, 1, 1e3},
    Unit{"cm", Dimension::length, 1, 1e2},     Unit{"m", Dimension::length, 1, 1},
    Unit{"km", Dimension::length, 1e3, 1},     Unit{"in", Dimension::length, 254, 1e4},
    Unit{"ft", Dimension::length, 3048, 1e4},  Unit{"deg", Dimension::angle, kPi, 180},
    Unit{"rad", Dimension::angle, 1, 1},       Unit{"turn", Dimension::angle, 2 * kPi, 1},
    Unit{"px", Dimension::image_length, 1, 1}, Unit{"s", Dimension::time, 1, 1},
    Unit{"ms", Dimension::time, 1, 1e3},       Unit{"ev", Dimension::exposure, 1, 1},
};

const Unit* find_unit(std::string_view name) {
    const auto found =
        std::find_if(kUnits.begin(), kUnits.end(), [&](const Unit& u) { return u.name == name; });
    return found == kUnits.end() ? nullptr : &*found;
}

/// from_chars takes no plus sign; "+-5" stays what it is, and so is no number.
std::string_view without_plus(std::string_view text) {
    const bool plus = text.starts_with('+') && !text.starts_with("+-");
    return plus ? text.substr(1) : text;
}

}  // namespace

bool is_unit(std::string_view name) {
    return find_unit(name) != nullptr;
}

std::vector<std::string> unit_names() {
    std::vector<std::string> names;
    for (const Unit& unit : kUnits) names.emplace_back(unit.name);
    return names;
}

std::optional<Quantity> parse_quantity(std::string_view text) {
    text = without_plus(text);
    double value = 0;
    const auto [end, failure] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (failure != std::errc{} || !std::isfinite(value)) return std::nullopt;
    std::string_view unit(end, std::size_t(text.data() + text.size() - end));
    while (unit.starts_with(' ')) unit.remove_prefix(1);
    if (!is_unit(unit)) return std::nullopt;
    return Quantity{value, std::string(unit)};
}

std::optional<double> convert_unit(double value, std::string_view from, std::string_view to) {
    const Unit* source = find_unit(from);
    const Unit* target = find_unit(to);
    if (!source || !target || source->dimension != target->dimension) return std::nullopt;
    if (source == target) return value;
    return value * (source->numerator * target->denominator) / (source->denominator * target->numerator);
}

std::vector<std::string> compatible_units(std::string_view unit) {
    std::vector<std::string> names;
    const Unit* wanted = find_unit(unit);
    for (const Unit& candidate : kUnits)
        if (wanted && candidate.dimension == wanted->dimension) names.emplace_back(candidate.name);
    return names;
}

std::optional<double> parse_number(std::string_view text) {
    text = without_plus(text);
    double value = 0;
    const auto [end, failure] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (failure != std::errc{} || end != text.data() + text.size() || !std::isfinite(value))
        return std::nullopt;
    return value;
}

std::string format_number(double value) {
    std::array<char, 32> text{};
    const auto [end, failure] = std::to_chars(text.data(), text.data() + text.size(), value);
    return failure == std::errc{} ? std::string(text.data(), end) : std::string("?");
}

}  // namespace aftershade
