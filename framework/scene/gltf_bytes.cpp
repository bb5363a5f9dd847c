#include "framework/scene/gltf_bytes.h"

#include <fmt/format.h>

#include <bit>
#include <cstdint>
#include <cstring>

namespace aftershade::scene {

namespace {

constexpr int kMaxJsonDepth = 200;
// A .glb: magic, version, length; then chunks, each with length and kind before it. The first is JSON.
constexpr std::size_t kJsonLengthAt = 12;
constexpr std::size_t kJsonAt = 20;

std::uint32_t little_endian_32(const unsigned char* bytes) {
    static_assert(std::endian::native == std::endian::little);
    std::uint32_t value = 0;
    std::memcpy(&value, bytes, 4);
    return value;
}

/// tinygltf forgets the 8 bytes of the second chunk's header when it compares that chunk with the file.
std::string check_chunks(std::span<const unsigned char> bytes) {
    const std::uint64_t json_end = kJsonAt + std::uint64_t(little_endian_32(&bytes[kJsonLengthAt]));
    if (json_end > bytes.size()) return "is cut short inside its JSON chunk";
    if (json_end + 8 > bytes.size()) return "";
    const std::uint64_t end = json_end + 8 + little_endian_32(&bytes[json_end]);
    if (end <= bytes.size()) return "";
    return fmt::format("is cut short inside its binary chunk: {} of {} bytes", bytes.size(), end);
}

std::string check_depth(std::span<const unsigned char> json) {
    int depth = 0;
    bool in_text = false;
    for (std::size_t i = 0; i < json.size(); ++i) {
        const unsigned char c = json[i];
        if (c == '"') in_text = !in_text;
        else if (in_text && c == '\\') ++i;
        else if (!in_text && (c == '[' || c == '{')) ++depth;
        else if (!in_text && (c == ']' || c == '}')) --depth;
        if (depth > kMaxJsonDepth) return fmt::format("its JSON nests more than {} levels", kMaxJsonDepth);
    }
    return "";
}

}  // namespace

bool is_binary_gltf(std::span<const unsigned char> bytes) {
    return bytes.size() >= kJsonAt && std::memcmp(bytes.data(), "glTF", 4) == 0;
}

std::string check_gltf_bytes(std::span<const unsigned char> bytes) {
    if (!is_binary_gltf(bytes)) return check_depth(bytes);
    const std::string fault = check_chunks(bytes);
    if (!fault.empty()) return fault;
    return check_depth(bytes.subspan(kJsonAt, little_endian_32(&bytes[kJsonLengthAt])));
}

}  // namespace aftershade::scene
