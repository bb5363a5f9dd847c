// Files that appear whole or not at all, and files read whole.
#pragma once

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

}  // namespace aftershade
