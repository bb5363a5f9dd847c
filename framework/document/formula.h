// Arithmetic in documents: "floor(width / 4)", over numbers that have names.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <string_view>

namespace aftershade {

inline constexpr std::size_t kMaxFormulaBytes = 1000;
inline constexpr int kMaxFormulaDepth = 32;  ///< brackets and signs, one in another

struct FormulaResult {
    double value = 0;
    std::string fault;   ///< "" where there is a value
    std::size_t at = 0;  ///< byte of the fault
};

/// The number of a name; nullopt: there is none of that name.
using FormulaNames = std::function<std::optional<double>(std::string_view name)>;

/// Numbers, names, + - * / with their usual order, brackets, and abs, ceil, floor, max, min, mod, pow, round,
/// sqrt, trunc. What is not finite is a value too.
FormulaResult evaluate_formula(std::string_view text, const FormulaNames& value_of);

}  // namespace aftershade
