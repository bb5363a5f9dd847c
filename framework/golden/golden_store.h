// Approved images outside of the tree. Each is a file that is named by its SHA-256, so that any copy will do
// and none can be forged.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <utility>

namespace aftershade {

inline constexpr std::uint64_t kMaxStoredBytes = std::uint64_t(1) << 30;  ///< of an image

/// "goldens", "https://host/path" or "rclone:remote:path": what a suite may name. Passwords, queries, other
/// schemes and rclone's connection strings, which may name a command, are none of these.
bool is_store(const std::string& text);
inline constexpr const char* kStorePattern =
    R"(^(https?://[A-Za-z0-9.:\[\]_-]+(/[A-Za-z0-9/.~%+:_-]*)?|rclone:[A-Za-z0-9_][A-Za-z0-9_-]*:[A-Za-z0-9/.+ _-]*|[^:-][^:]*)$)";

/// "<digest>.exr".
std::string stored_name(const std::string& digest);

/// The SHA-256 of a file; "" where it is not a regular file, is larger than a stored image or cannot be read.
std::string sha256_of_file(const std::filesystem::path& file);

class GoldenStore {
public:
    /// `store` is_store(). A folder is named from that of the suite. `timeout`: of the transfer of one
    /// image.
    GoldenStore(std::string store, std::filesystem::path suite_folder, std::chrono::milliseconds timeout)
        : store_(std::move(store)), suite_folder_(std::move(suite_folder)), timeout_(timeout) {}

    /// By digest, why there is no such image; else it is in `folder`, with a hash that has been verified.
    /// Throws Error(ErrorKind::output) where the folder cannot be written.
    std::map<std::string, std::string> fetch(const std::set<std::string>& digests,
                                             const std::filesystem::path& folder,
                                             const std::atomic<bool>& interrupt) const;
    /// Those that the store lacks, or for which it gives no answer. Does not fetch them.
    std::set<std::string> lacking(const std::set<std::string>& digests,
                                  const std::atomic<bool>& interrupt) const;
    /// From `folder`, and fetches them again to see that they are there. Throws Error(ErrorKind::output) with
    /// the first reason.
    void push(const std::set<std::string>& digests, const std::filesystem::path& folder,
              const std::atomic<bool>& interrupt) const;

private:
    enum class Direction { fetch, push, find };
    using Faults = std::map<std::string, std::string>;
    Faults transfer(Direction direction, const std::set<std::string>& digests,
                    const std::filesystem::path& folder, const std::atomic<bool>& interrupt) const;
    Faults by_folder(Direction direction, const std::set<std::string>& digests,
                     const std::filesystem::path& folder) const;
    Faults by_curl(Direction direction, const std::set<std::string>& digests,
                   const std::filesystem::path& folder, const std::atomic<bool>& interrupt) const;
    Faults by_rclone(Direction direction, const std::set<std::string>& digests,
                     const std::filesystem::path& folder, const std::atomic<bool>& interrupt) const;

    std::string store_;
    std::filesystem::path suite_folder_;
    std::chrono::milliseconds timeout_;
};

}  // namespace aftershade
