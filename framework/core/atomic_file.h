// Files that appear whole or not at all, and files read whole.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <system_error>

#include "framework/core/error.h"

namespace aftershade {

/// Names a temporary file beside `final_path` (".<name>.<pid>-<n>.tmp"); commit() flushes it to disk and
/// renames it, the destructor removes it if it was not committed.
class AtomicFile {
public:
    explicit AtomicFile(std::filesystem::path final_path);
    ~AtomicFile();
    AtomicFile(const AtomicFile&) = delete;
    AtomicFile& operator=(const AtomicFile&) = delete;

    const std::filesystem::path& temporary_path() const { return temporary_path_; }
    /// Throws Error(ExitCode::output) naming the final path and the system's reason.
    void commit();

private:
    std::filesystem::path final_path_;
    std::filesystem::path temporary_path_;
    bool committed_ = false;
};

/// Replaces the file by this text. Throws Error(ExitCode::output) naming the path.
void write_text_file(const std::filesystem::path& path, std::string_view text);

/// The file's bytes as they are, also where the system does not know their number (/proc). "" where it cannot
/// be read; `failure` says why, and is cleared otherwise.
std::string read_text_file(const std::filesystem::path& path, std::error_code& failure);
/// The same. Throws Error(code) naming the path and the system's reason.
std::string read_text_file(const std::filesystem::path& path, ExitCode code);
/// The bytes of a regular file of at most `max_bytes`. Where it is none, is larger or cannot be read: "", and
/// `fault` says why, as a message ends: "no such file", "the file has 9 bytes, the limit is 5". `fault` is
/// cleared otherwise. Nothing else than a regular file is opened: a pipe would wait for a writer.
std::string read_regular_file(const std::filesystem::path& path, std::uintmax_t max_bytes,
                              std::string& fault);
/// Whether a regular file begins with these bytes; false where it cannot be read.
bool file_begins_with(const std::filesystem::path& path, std::string_view bytes);

}  // namespace aftershade
