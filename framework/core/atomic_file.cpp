#include "framework/core/atomic_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <utility>

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

std::string read_text_file(const fs::path& path, std::error_code& failure) {
    failure.clear();
    errno = 0;
    std::ifstream in(path, std::ios::binary);
    std::string text;
    std::array<char, 65536> buffer;
    while (in && in.read(buffer.data(), buffer.size()).gcount() > 0)
        text.append(buffer.data(), std::size_t(in.gcount()));
    // A folder can be opened, but not read.
    if (in.is_open() && !in.bad()) return text;
    failure.assign(errno != 0 ? errno : EIO, std::generic_category());
    return "";
}

std::string read_text_file(const fs::path& path, ExitCode code) {
    std::error_code failure;
    std::string text = read_text_file(path, failure);
    if (failure) throw Error(code, path.string() + ": cannot be read: " + failure.message());
    return text;
}

std::string read_regular_file(const fs::path& path, std::uintmax_t max_bytes, std::string& fault) {
    fault.clear();
    std::error_code failure;
    const fs::file_status status = fs::status(path, failure);
    const std::uintmax_t size = fs::is_regular_file(status) ? fs::file_size(path, failure) : 0;
    std::string text;
    if (!fs::exists(status)) fault = "no such file";
    else if (!fs::is_regular_file(status)) fault = "is not a regular file";
    else if (!failure && size > max_bytes)
        fault = "the file has " + std::to_string(size) + " bytes, the limit is " + std::to_string(max_bytes);
    else if (text = read_text_file(path, failure); failure) fault = "cannot be read: " + failure.message();
    return text;
}

bool file_begins_with(const fs::path& path, std::string_view bytes) {
    std::error_code failure;
    if (!fs::is_regular_file(path, failure)) return false;
    std::string begin(bytes.size(), '\0');
    std::ifstream file(path, std::ios::binary);
    return file.read(begin.data(), std::streamsize(begin.size())) && begin == bytes;
}

}  // namespace aftershade
