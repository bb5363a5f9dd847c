// Units that documents may write: "85 mm", "0.5 m", "180 deg".
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace aftershade {

struct Quantity {
    double value = 0;
    std::string unit;  ///< a name that is_unit() accepts
};

/// um mm cm m km in ft, deg rad turn, px, s ms, ev (stops).
bool is_unit(std::string_view name);
std::vector<std::string> unit_names();
/// "85 mm", "85mm", "-1.5e3 px"; nullopt where the text is not a number followed by a known unit.
std::optional<Quantity> parse_quantity(std::string_view text);
/// nullopt where the two measure different things ("mm" and "deg").
std::optional<double> convert_unit(double value, std::string_view from, std::string_view to);
/// Units that convert to `unit`.
std::vector<std::string> compatible_units(std::string_view unit);

/// The whole text as a number, independent of the locale; "inf" and "nan" are not numbers here.
std::optional<double> parse_number(std::string_view text);
/// The shortest text that reads back as the same double.
std::string format_number(double value);

}  // namespace aftershade
