#include "framework/file/exr_loss.h"

#include <algorithm>
#include <array>
#include <string>

#include "framework/base/text.h"
#include "framework/file/exr_file.h"

namespace aftershade {

namespace {

template <std::size_t n>
bool is_among(const std::array<std::string_view, n>& names, std::string_view name) {
    return std::find(names.begin(), names.end(), name) != names.end();
}

}  // namespace

bool loses_bits(std::string_view compression, std::string_view channel, PixelType type) {
    const std::string_view last = channel.substr(channel.rfind('.') + 1);
    if (!is_lossy_compression(compression) || type == PixelType::uint32) return false;
    if (compression.starts_with("b44")) return type == PixelType::half;
    if (compression == "pxr24") return type == PixelType::float32;
    // OpenEXR's sDefaultChannelRules, which heed case.
    constexpr std::array<std::string_view, 6> kOfDwa = {"R", "G", "B", "Y", "RY", "BY"};
    if (compression.starts_with("dwa")) return is_among(kOfDwa, last);
    constexpr std::array<std::string_view, 8> kOfJ2k = {"r", "g", "b", "red", "green", "blue", "grn", "bl"};
    if (compression == "lj2k") return is_among(kOfJ2k, lower_case(std::string(last)));
    return true;
}

}  // namespace aftershade
