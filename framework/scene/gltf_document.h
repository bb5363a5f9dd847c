// A glTF file as tinygltf reads it; for the sources of this folder.
#pragma once

#include <filesystem>
#include <string>

// Linked as Debian's library: the implementation is not compiled here.
#include <tiny_gltf.h>

namespace aftershade::scene {

/// Throws Error(ErrorKind::usage) of `path: what`.
[[noreturn]] void fail_gltf(const std::filesystem::path& path, const std::string& what);

/// With `keeps_images`, tinygltf::Image::image has the bytes of the image's file or data URI. Throws
/// Error(ErrorKind::usage) that begins with the path.
tinygltf::Model load_gltf(const std::filesystem::path& path, bool keeps_images);

/// Why a file that the document names could not be read.
std::string gltf_file_fault(const std::filesystem::path& path, const std::string& uri);

}  // namespace aftershade::scene
