// Where the files of documents from untrusted sources can lie.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "framework/core/open_file.h"

namespace aftershade {

/// "" where `file` lies in `folder` or below with links followed, or in a folder that the user allowed. Else
/// why not, with the remedy, as a message continues after the file's name: "leads out of the folder
/// 'effects/x'
/// ...".
std::string out_of_bounds(const std::filesystem::path& file, const std::filesystem::path& folder);

/// A regular file that lies in `folder` under the relative path `name` and is reached without following a
/// link: for untrusted folders. Else nullopt, and `fault` says why, as a message ends.
std::optional<OpenFile> open_file_below(const std::filesystem::path& folder,
                                        const std::filesystem::path& name, std::string& fault);
/// The bytes of such a file, of at most `max_bytes`. Else "", and `fault` says why.
std::string read_file_below(const std::filesystem::path& folder, const std::filesystem::path& name,
                            std::uintmax_t max_bytes, std::string& fault);

/// Folders of --allow-path, and of $AFTERSHADE_ALLOW_PATH, separated by colons.
std::vector<std::filesystem::path> allowed_folders();
/// For this process and those that it starts: adds to the variable.
void allow_folders(const std::vector<std::string>& folders);

}  // namespace aftershade
