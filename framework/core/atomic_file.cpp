#include "framework/core/atomic_file.h"

#include <fcntl.h>
#include <signal.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <charconv>
#include <climits>
#include <cstring>
#include <fstream>
#include <utility>

namespace aftershade {

namespace fs = std::filesystem;

namespace {

constexpr std::string_view kTemporaryMark = ".aftershade-";
constexpr std::string_view kTemporaryEnd = ".tmp";

/// The host part of temporary names: "node7-".
std::string host_mark() {
    std::array<char, HOST_NAME_MAX + 1> name{};
    return gethostname(name.data(), name.size() - 1) == 0 ? std::string(name.data()) + "-" : "-";
}

/// The process that made the temporary file `name`; 0 where it is no such file, or one of another host.
pid_t maker_of_temporary(std::string_view name, std::string_view host) {
    const std::size_t mark = name.rfind(kTemporaryMark);
    if (!name.starts_with('.') || !name.ends_with(kTemporaryEnd) || mark == std::string_view::npos) return 0;
    std::string_view rest = name.substr(mark + kTemporaryMark.size());
    rest.remove_suffix(kTemporaryEnd.size());
    if (!rest.starts_with(host)) return 0;
    rest.remove_prefix(host.size());
    pid_t process = 0;
    unsigned number = 0;
    const char* const end = rest.data() + rest.size();
    const auto pid = std::from_chars(rest.data(), end, process);
    if (pid.ec != std::errc{} || pid.ptr == end || *pid.ptr != '-') return 0;
    const auto count = std::from_chars(pid.ptr + 1, end, number);
    return count.ec == std::errc{} && count.ptr == end && process > 0 ? process : 0;
}

/// One that has ended but that nobody has waited for yet is not: proc(5), the state behind the name in
/// brackets.
bool is_running(pid_t process) {
    if (kill(process, 0) != 0 && errno == ESRCH) return false;
    std::ifstream file("/proc/" + std::to_string(process) + "/stat");
    std::string line;
    if (!std::getline(file, line)) return true;
    const std::size_t name_end = line.rfind(") ");
    return name_end == std::string::npos || (line[name_end + 2] != 'Z' && line[name_end + 2] != 'X');
}

/// A process of another PID namespace looks dead from here, but its lock holds.
bool is_locked(const fs::path& file) {
    const int descriptor = open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW);
    if (descriptor < 0) return true;
    const bool locked = flock(descriptor, LOCK_EX | LOCK_NB) != 0;
    close(descriptor);
    return locked;
}

struct Descriptor {
    explicit Descriptor(int opened) : number(opened) {}
    ~Descriptor() {
        if (number >= 0) close(number);
    }
    Descriptor(const Descriptor&) = delete;
    Descriptor& operator=(const Descriptor&) = delete;
    const int number;
};

constexpr const char* kNotRegular = "is not a regular file";

}  // namespace

AtomicFile::AtomicFile(fs::path final_path) : final_path_(std::move(final_path)) {
    // The process id keeps two commands apart, the counter two files of one command.
    static std::atomic<unsigned> counter{0};
    constexpr std::size_t kMostOfName = 128;  // of 255 bytes that a name may have; the host may take 64
    temporary_path_ =
        final_path_.parent_path() / ("." + final_path_.filename().string().substr(0, kMostOfName) +
                                     std::string(kTemporaryMark) + host_mark() + std::to_string(getpid()) +
                                     "-" + std::to_string(counter++) + std::string(kTemporaryEnd));
    constexpr int kMode = 0666;  // less the user's umask, as fopen() does
    lock_ = open(temporary_path_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, kMode);
    if (lock_ >= 0) flock(lock_, LOCK_EX | LOCK_NB);
}

AtomicFile::~AtomicFile() {
    if (lock_ >= 0) close(lock_);
    if (committed_) return;
    std::error_code ignored;
    fs::remove(temporary_path_, ignored);
}

std::vector<fs::path> remove_stale_temporaries(const fs::path& folder) {
    std::vector<fs::path> removed;
    const std::string host = host_mark();
    std::error_code failure;
    for (fs::directory_iterator at(folder.empty() ? fs::path(".") : folder, failure), end;
         !failure && at != end; at.increment(failure)) {
        const pid_t maker = maker_of_temporary(at->path().filename().string(), host);
        std::error_code ignored;
        if (maker == 0 || is_running(maker) || !at->is_regular_file(ignored) || is_locked(at->path()))
            continue;
        if (fs::remove(at->path(), ignored)) removed.push_back(at->path());
    }
    std::sort(removed.begin(), removed.end());
    return removed;
}

void prepare_output_folder(const fs::path& file) {
    if (file.empty()) return;
    const fs::path folder = file.has_parent_path() ? file.parent_path() : fs::path(".");
    const auto refuse = [&](const std::string& what) {
        throw Error(ExitCode::output, file.string() + ": " + what);
    };
    std::error_code failure;
    if (fs::exists(folder, failure) && !fs::is_directory(folder, failure))
        refuse("'" + folder.string() + "' is a file, a folder is expected");
    fs::create_directories(folder, failure);
    if (failure) refuse("the folder '" + folder.string() + "' cannot be made: " + failure.message());
    if (access(folder.c_str(), W_OK | X_OK) != 0)
        refuse("nothing can be written into the folder '" + folder.string() + "': " + std::strerror(errno) +
               " (name another folder, or change its permissions)");
    remove_stale_temporaries(folder);
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
    errno = 0;
    std::ofstream out(file.temporary_path(), std::ios::binary);
    out << text;
    out.close();
    if (!out)
        throw Error(ExitCode::output,
                    path.string() + ": cannot be written: " + std::strerror(errno ? errno : EIO));
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
    // Without O_NONBLOCK a pipe would wait for a writer. What is opened is what is judged.
    const Descriptor file(open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC));
    struct stat status;
    if (file.number < 0 || fstat(file.number, &status) != 0) {
        fault = errno == ENOENT ? "no such file" : std::string("cannot be read: ") + std::strerror(errno);
        // A socket, or a device that has no driver.
        if (errno == ENXIO || errno == ENODEV) fault = kNotRegular;
        return "";
    }
    if (!S_ISREG(status.st_mode)) {
        fault = kNotRegular;
        return "";
    }
    const auto too_large = [&](std::uintmax_t size) {
        fault = "the file has " + std::to_string(size) + " bytes, the limit is " + std::to_string(max_bytes);
        return std::string();
    };
    if (std::uintmax_t(status.st_size) > max_bytes) return too_large(std::uintmax_t(status.st_size));
    std::string text;
    text.reserve(std::size_t(status.st_size));
    std::array<char, 65536> buffer;
    ssize_t count = 0;
    while ((count = read(file.number, buffer.data(), buffer.size())) > 0) {
        text.append(buffer.data(), std::size_t(count));
        if (text.size() > max_bytes) return too_large(text.size());
    }
    if (count == 0) return text;
    fault = std::string("cannot be read: ") + std::strerror(errno);
    return "";
}

bool file_begins_with(const fs::path& path, std::string_view bytes) {
    std::error_code failure;
    if (!fs::is_regular_file(path, failure)) return false;
    std::string begin(bytes.size(), '\0');
    std::ifstream file(path, std::ios::binary);
    return file.read(begin.data(), std::streamsize(begin.size())) && begin == bytes;
}

}  // namespace aftershade
