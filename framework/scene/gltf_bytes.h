// The bytes of a glTF file before they are parsed.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace aftershade::scene {

/// Fills `bytes` with a regular file of at most 1 GiB. What is wrong, without the path; "" when nothing.
std::string read_gltf_bytes(const std::filesystem::path& path, std::vector<unsigned char>& bytes);

/// Whether they are a .glb, by what they begin with.
bool is_binary_gltf(std::span<const unsigned char> bytes);

/// What tinygltf 2.7 would not survive, whatever the file's kind: a binary chunk that ends outside the
/// file, JSON that nests so deep that reading it by recursion overflows the stack. "" when nothing.
std::string check_gltf_bytes(std::span<const unsigned char> bytes);

}  // namespace aftershade::scene
