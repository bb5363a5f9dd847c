// Small things that text needs in several places.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

namespace aftershade {

/// a-z, 0-9 and _, beginning with a letter: what ids, parameters and steps are named by.
bool is_snake_case(std::string_view name);
/// What an error says of a name that is not: "<thing> 'Name' " and this.
inline constexpr const char* kMustBeSnakeCase = "must be snake_case: a-z, 0-9 and _, beginning with a letter";

/// FNV-1a, 64 bits (Fowler, Noll and Vo 1991). It names files and finds damage; it does not resist intent.
inline constexpr std::uint64_t kFnvBegin = 14695981039346656037ull;
std::uint64_t fnv1a(std::span<const std::byte> bytes, std::uint64_t hash = kFnvBegin);

}  // namespace aftershade
