#include "framework/core/atomic_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <utility>

#include "framework/core/error.h"

namespace aftershade {

namespace fs = std::filesystem;

AtomicFile::AtomicFile(fs::path final_path) : final_path_(std::move(final_path)) {
    // The process id keeps two commands apart, the counter two files of one command.
    static std::atomic<unsigned> counter{0};
    temporary_path_ =
        final_path_.parent_path() / ("." + final_path_.filename().string() + "." + std::to_string(getpid()) +
                                     "-" + std::to_string(counter++) + ".tmp");
}

AtomicFile::~AtomicFile() {
    if (committed_) return;
    std::error_code ignored;
    fs::remove(temporary_path_, ignored);
}

void AtomicFile::commit() {
    const auto fail = [&](const char* step) {
        throw Error(ExitCode::output, final_path_.string() + ": " + step + ": " + std::strerror(errno));
    };
    const int file = open(temporary_path_.c_str(), O_RDONLY | O_CLOEXEC);
    if (file < 0) fail("cannot open what was written");
    const int flushed = fsync(file);
    close(file);
    if (flushed != 0) fail("cannot flush to disk");
    if (std::rename(temporary_path_.c_str(), final_path_.c_str()) != 0) fail("cannot rename into place");
    committed_ = true;
}

void write_text_file(const fs::path& path, std::string_view text) {
    AtomicFile file(path);
    std::ofstream out(file.temporary_path(), std::ios::binary);
    out << text;
    out.close();
    if (!out) throw Error(ExitCode::output, path.string() + ": cannot be written");
    file.commit();
}

}  // namespace aftershade
