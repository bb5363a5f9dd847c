// Compiled programs on disk, so that the next run need not compile them.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>

#include "framework/gpu/program.h"

namespace aftershade {

/// A folder with one file for each program, named by a hash of its key; the file holds the whole key, so two
/// keys of one hash are only a miss. Files appear by rename: any number of processes may share the folder.
/// A file that is cut short, damaged or of another layout counts as absent and is replaced. Nothing here
/// fails: a folder that cannot be written keeps nothing. Beyond 256 MiB, the programs that were written first
/// go. [any thread]
class ProgramStore {
public:
    /// Keeps nothing.
    ProgramStore() = default;
    /// Makes the folder with the first program that it keeps.
    explicit ProgramStore(std::filesystem::path folder, std::uint64_t max_bytes = kMaxBytes)
        : named_(folder), folder_(std::move(folder)), max_bytes_(max_bytes) {}
    /// `named` / `below`; where `below` is a link, nothing is kept.
    ProgramStore(std::filesystem::path named, const std::filesystem::path& below)
        : named_(std::move(named)), below_(below), folder_(named_ / below) {}
    /// $AFTERSHADE_CACHE, which may be "off"; else $XDG_CACHE_HOME/aftershade; else ~/.cache/aftershade.
    static ProgramStore from_environment();
    static constexpr std::uint64_t kMaxBytes = std::uint64_t(256) << 20;

    bool is_on() const { return !folder_.empty(); }
    const std::filesystem::path& folder() const { return folder_; }
    /// Makes the folder. Returns the reason why it cannot keep programs, with the remedy, or "".
    std::string fault() const;
    /// The key is all that the program depends on: sources, renderer, versions.
    std::optional<gpu::ProgramBinary> load(const std::string& key) const;
    void save(const std::string& key, const gpu::ProgramBinary& binary) const;
    std::filesystem::path file_of(const std::string& key) const;

private:
    void make_room() const;

    /// Throws Error where it cannot be, or is a link below what the user named.
    void make_folder() const;

    std::filesystem::path named_, below_;
    std::filesystem::path folder_;  // both; empty: off
    std::uint64_t max_bytes_ = kMaxBytes;
};

}  // namespace aftershade
