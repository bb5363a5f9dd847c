// Git LFS leaves a small text in place of a file whose content has not been fetched.
#pragma once

#include <filesystem>
#include <string>

#include "framework/base/atomic_file.h"

namespace aftershade {

/// The fault of such a file, and the remedy; "" for any other file.
inline std::string lfs_fault(const std::filesystem::path& path) {
    // The first line of every pointer: the specification of Git LFS, "The Pointer".
    if (!file_begins_with(path, "version https://git-lfs")) return "";
    return "is a pointer of Git LFS, not the file itself (fetch it: git lfs pull)";
}

}  // namespace aftershade
