// The words that documents and options have for the values of an enumeration.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <string_view>
#include <utility>

namespace aftershade {

template <class Value, std::size_t N>
using Names = std::array<std::pair<Value, std::string_view>, N>;

/// nullopt for a word that is not in the table.
template <class Value, std::size_t N>
std::optional<Value> value_named(const Names<Value, N>& names, std::string_view name) {
    const auto found = std::ranges::find(names, name, &std::pair<Value, std::string_view>::second);
    return found == names.end() ? std::nullopt : std::optional(found->first);
}

/// `value` must be in the table.
template <class Value, std::size_t N>
std::string_view name_of(const Names<Value, N>& names, Value value) {
    return std::ranges::find(names, value, &std::pair<Value, std::string_view>::first)->second;
}

}  // namespace aftershade
