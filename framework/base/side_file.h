// Files beside the user's own, under names that the user did not give: journals, locks, sidecars, manifests,
// reports. A user who may write into their folder can put a link, a pipe or a device there. The user named
// `folder`, which may be, or lie behind, a link; below it no link is followed.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "framework/base/open_file.h"

namespace aftershade {

enum class FileUse {
    read,
    append,  ///< at its end, and read; made where it is absent
    update   ///< in any place, and read; made where it is absent
};

/// The fault of a file that is not there.
inline constexpr const char* kNoSuchFile = "no such file";

/// The regular file with the relative path `name`. Else nullopt, and `fault` says why with the remedy, as a
/// message continues after the file's name. A file that is written has no second name (hard link) either.
std::optional<OpenFile> open_file_below(const std::filesystem::path& folder,
                                        const std::filesystem::path& name, std::string& fault,
                                        FileUse use = FileUse::read);
/// The bytes of such a file, of at most `max_bytes`. Else "", and `fault` says why.
std::string read_file_below(const std::filesystem::path& folder, const std::filesystem::path& name,
                            std::uintmax_t max_bytes, std::string& fault);

/// `folder` / `name`, for writers that replace files by rename (atomic_file.h). Throws
/// Error(ErrorKind::output) naming the link, where one stands there or on the way, and the remedy.
std::filesystem::path path_below(const std::filesystem::path& folder, const std::filesystem::path& name);
/// Makes the folders down to `folder` / `name` that are absent. Throws likewise, and where one cannot be
/// made.
std::filesystem::path make_folder_below(const std::filesystem::path& folder,
                                        const std::filesystem::path& name);

}  // namespace aftershade
