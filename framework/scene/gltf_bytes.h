// The bytes of a glTF file before they are parsed.
#pragma once

#include <cstdint>
#include <span>
#include <string>

namespace aftershade::scene {

/// Largest file that is read, and largest buffer of one.
inline constexpr std::uintmax_t kMaxGltfBytes = 1024u * 1024 * 1024;

/// Whether they are a .glb, by what they begin with.
bool is_binary_gltf(std::span<const unsigned char> bytes);

/// Faults that crash tinygltf 2.7, in any kind of file: a binary chunk that ends outside the file, JSON that
/// nests so deep that reading it by recursion overflows the stack. "" without a fault.
std::string check_gltf_bytes(std::span<const unsigned char> bytes);

}  // namespace aftershade::scene
