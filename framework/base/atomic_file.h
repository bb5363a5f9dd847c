// Files that appear whole or not at all, and files read whole.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

#include "framework/base/error.h"

namespace aftershade {

/// Makes an empty temporary file beside `final_path`, named ".<name>.aftershade-<host>-<pid>-<n>.tmp", and
/// holds a lock (flock) on it; commit() flushes it to disk and renames it, the destructor removes it if it
/// was not committed. A symbolic link is followed: the file that it leads to is replaced, the link stays. The
/// permissions of a file that is replaced are kept; a new file has those of the umask. The first one that a
/// process makes in a folder removes what killed processes left there (remove_stale_temporaries).
class AtomicFile {
public:
    /// Throws Error(ErrorKind::output) where the path is a pipe, a socket or a device, which no rename may
    /// replace. Where the file cannot be made it says nothing: whoever opens it has the reason.
    explicit AtomicFile(std::filesystem::path final_path);
    ~AtomicFile();
    AtomicFile(const AtomicFile&) = delete;
    AtomicFile& operator=(const AtomicFile&) = delete;

    const std::filesystem::path& temporary_path() const { return temporary_path_; }
    /// Gives it the bytes of another file, not its permissions. Throws Error(ErrorKind::output) naming the
    /// final path, the other file where that cannot be read, and the system's reason.
    void copy_from(const std::filesystem::path& file);
    /// `no`: after a crash of the system the file may lack its contents.
    enum class Flush { no, yes };
    /// Throws Error(ErrorKind::output) naming the final path and the system's reason.
    void commit(Flush flush = Flush::yes);

private:
    std::filesystem::path final_path_;
    std::filesystem::path target_;  ///< at the end of the links
    std::filesystem::path temporary_path_;
    std::optional<std::filesystem::perms> kept_;  ///< of the file that is replaced
    int lock_ = -1;
    bool committed_ = false;
};

/// The same for a folder: an empty temporary one beside `final_path`, which commit() renames and the
/// destructor removes with all that it holds. Clears those that killed processes left there.
class AtomicFolder {
public:
    /// Throws Error(ErrorKind::output) where it cannot be made, naming the final path and the system's
    /// reason.
    explicit AtomicFolder(std::filesystem::path final_path);
    ~AtomicFolder();
    AtomicFolder(const AtomicFolder&) = delete;
    AtomicFolder& operator=(const AtomicFolder&) = delete;

    const std::filesystem::path& temporary_path() const { return temporary_path_; }
    /// Throws Error(ErrorKind::output), also where something has the final path by now.
    void commit();

private:
    std::filesystem::path final_path_;
    std::filesystem::path temporary_path_;
    int lock_ = -1;
    bool committed_ = false;
};

/// Removes what AtomicFile left in `folder` when its process was killed, and returns the paths. A file counts
/// as left behind if its name says this host and a process that no longer runs, and no process holds its
/// lock; those of other hosts stay, since their processes cannot be seen from here.
std::vector<std::filesystem::path> remove_stale_temporaries(const std::filesystem::path& folder);

/// Makes the folder of a file to be written, and removes what a killed run left in it: better before
/// the work than after it. Throws Error(ErrorKind::output) naming the file and the reason where the folder
/// cannot be made or nothing can be written into it. "" is not a file.
void prepare_output_folder(const std::filesystem::path& file);

/// Replaces the file by this text; a pipe, a socket, a device and what /dev/stdout leads to get it directly.
/// Throws Error(ErrorKind::output) naming the path, also for a pipe without a reader.
void write_text_file(const std::filesystem::path& path, std::string_view text);

/// The bytes of a regular file of at most `max_bytes`. Where it is none, is larger or cannot be read: "", and
/// `fault` says why, as a message ends: "no such file", "the file has 9 bytes, the limit is 5". `fault` is
/// cleared otherwise. Pipes and devices are refused, not waited for, and a file that grows while it is read
/// ends at the limit.
std::string read_regular_file(const std::filesystem::path& path, std::uintmax_t max_bytes,
                              std::string& fault);
/// More than any text that this project reads.
inline constexpr std::uintmax_t kMaxTextFileBytes = 16u << 20;
/// The same. Throws Error(code) naming the path and the fault.
std::string read_text_file(const std::filesystem::path& path, ErrorKind code,
                           std::uintmax_t max_bytes = kMaxTextFileBytes);
/// Replaces the file by `text` if it holds `before`, or is absent; else false. Of several processes that do
/// this at once, none replaces what another one has just written. Throws Error(ErrorKind::output) naming the
/// path.
bool replace_text_file(const std::filesystem::path& path, std::string_view before, std::string_view text);
/// Whether a regular file begins with these bytes; false where it cannot be read.
bool file_begins_with(const std::filesystem::path& path, std::string_view bytes);

}  // namespace aftershade
