// Which files a command reads, so that none of its outputs replaces one of them.
#pragma once

#include <compare>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <unordered_map>
#include <unordered_set>

#include "framework/base/diagnostics.h"

namespace aftershade {

/// Files are known by what they are (device and inode), so that links and other spellings of a path are
/// found, and by their paths with links followed, where they are not there yet. [one thread at a time]
class InputFiles {
public:
    /// A file that is read, or will be; Diagnostics::documents() lists what has been. "" is none.
    void add(const std::filesystem::path& file);
    void add(std::span<const std::filesystem::path> files);

    /// The input that writing to `output` would replace, as it was named.
    std::optional<std::filesystem::path> replaced_by(const std::filesystem::path& output) const;

    /// Notes an output. A fault at `place` where it is an input, or the name of an output that was noted
    /// before. "" is none. True where it is neither.
    bool check_output(const Place& place, const std::filesystem::path& output, Diagnostics& diagnostics);

private:
    struct Identity {
        std::uint64_t device = 0;
        std::uint64_t inode = 0;
        auto operator<=>(const Identity&) const = default;
    };
    /// The kind of file at a path.
    struct Found {
        std::optional<Identity> identity;  ///< of a regular file
        bool is_file = true;               ///< a regular file, or nothing yet
        std::string path;                  ///< with links followed, so that two ways to one file are one
    };
    /// Read once, since a sequence may have a million files.
    struct Folder {
        std::string path;                       ///< with links followed, and a slash
        std::unordered_set<std::string> names;  ///< of what lies in it
    };
    const Folder& folder_of(const std::string& text) const;
    Found find(const std::filesystem::path& path) const;
    std::optional<std::filesystem::path> input_at(const Found& output) const;

    std::map<Identity, std::filesystem::path> by_identity_;
    std::unordered_map<std::string, std::filesystem::path> by_path_;
    mutable std::unordered_map<std::string, Folder> folders_;
    std::unordered_set<std::string> outputs_;  ///< with links followed
};

}  // namespace aftershade
