#include "framework/core/text.h"

#include <algorithm>

namespace aftershade {

bool is_snake_case(std::string_view name) {
    const auto is_letter = [](char c) { return c >= 'a' && c <= 'z'; };
    const auto fits = [&](char c) { return is_letter(c) || (c >= '0' && c <= '9') || c == '_'; };
    return !name.empty() && is_letter(name.front()) && std::all_of(name.begin(), name.end(), fits);
}

std::uint64_t fnv1a(std::span<const std::byte> bytes, std::uint64_t hash) {
    for (const std::byte byte : bytes) hash = (hash ^ std::uint64_t(byte)) * 1099511628211ull;
    return hash;
}

}  // namespace aftershade
