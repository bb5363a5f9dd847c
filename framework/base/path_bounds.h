// Where the files of documents from untrusted sources can lie.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace aftershade {

/// "" where `file` lies in `folder` or below with links followed, or in a folder that the user allowed. Else
/// why not, with the remedy, as a message continues after the file's name: "leads out of the folder
/// 'effects/x'
/// ...".
std::string out_of_bounds(const std::filesystem::path& file, const std::filesystem::path& folder);

/// Whether `file` goes up ("..") from a folder that is neither in one of `folders` or of the allowed ones,
/// nor around one, with links followed. Whether such a file is found depends on whether that folder exists.
bool has_detour(const std::filesystem::path& file, std::vector<std::filesystem::path> folders);

/// While it lives, what this thread reads may name only those files of which `why_not` says "": a rule for
/// documents that come from elsewhere than the disk. Without one every file may be named.
class FileRule {
public:
    using WhyNot = std::function<std::string(const std::filesystem::path& file)>;

    explicit FileRule(WhyNot why_not);
    ~FileRule();
    FileRule(const FileRule&) = delete;
    FileRule& operator=(const FileRule&) = delete;

    /// Why a document may not name `file`, as a message continues after its name; "" where it may.
    static std::string why_not(const std::filesystem::path& file);

private:
    WhyNot why_not_;
    FileRule* outer_;
};

/// With links followed as far as there is something.
std::filesystem::path resolved_path(const std::filesystem::path& path);

/// Folders of --allow-path, and of $AFTERSHADE_ALLOW_PATH, separated by colons.
std::vector<std::filesystem::path> allowed_folders();
/// For this process and those that it starts: adds to the variable.
void allow_folders(const std::vector<std::string>& folders);

}  // namespace aftershade
