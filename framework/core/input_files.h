// Which files a command reads, so that none of its outputs replaces one of them.
#pragma once

#include <compare>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <span>

#include "framework/core/diagnostics.h"

namespace aftershade {

/// Files are known by what they are (device and inode), so that links and other spellings of a path are
/// found, and by their paths with links followed, where they are not there yet. [one thread at a time]
class InputFiles {
public:
    /// With the documents that this process has read so far (note_document).
    InputFiles();

    /// A file that is read, or will be. "" is none.
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
    static std::optional<Identity> identity_of(const std::filesystem::path& file);
    /// With links followed, so that two ways to one file are one.
    std::filesystem::path resolved(const std::filesystem::path& path) const;

    std::map<Identity, std::filesystem::path> by_identity_;
    std::map<std::filesystem::path, std::filesystem::path> by_path_;
    /// Folders with links followed: once each, since a sequence may have a million files.
    mutable std::map<std::filesystem::path, std::filesystem::path> folders_;
    std::set<std::filesystem::path> outputs_;  ///< with links followed
};

/// Every reader of documents notes them here, so that none is forgotten where a document names others.
/// [thread-safe]
void note_document(const std::filesystem::path& file);

}  // namespace aftershade
