#include "framework/base/atomic_file.h"

#include <fcntl.h>
#include <signal.h>
#include <sys/file.h>
#include <sys/sendfile.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <charconv>
#include <climits>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <mutex>
#include <set>
#include <utility>

#include "framework/base/child_process.h"

namespace aftershade {

namespace fs = std::filesystem;

namespace {

constexpr std::string_view kTemporaryMark = ".aftershade-";
constexpr std::string_view kTemporaryEnd = ".tmp";
constexpr std::string_view kTemporaryFolderEnd = ".new";

/// The host part of temporary names: "node7-".
std::string host_mark() {
    std::array<char, HOST_NAME_MAX + 1> name{};
    return gethostname(name.data(), name.size() - 1) == 0 ? std::string(name.data()) + "-" : "-";
}

/// A name that keeps apart the files of one command by a counter, and those of two by the process id.
fs::path temporary_name(const fs::path& final_path, std::string_view end) {
    static std::atomic<unsigned> counter{0};
    constexpr std::size_t kMostOfName = 128;  // of 255 bytes that a name may have; the host may take 64
    return final_path.parent_path() /
           ("." + final_path.filename().string().substr(0, kMostOfName) + std::string(kTemporaryMark) +
            host_mark() + std::to_string(getpid()) + "-" + std::to_string(counter++) + std::string(end));
}

/// The process that made the temporary file or folder `name`; 0 where it is no such name, or one of another
/// host.
pid_t maker_of_temporary(std::string_view name, std::string_view end_of_name, std::string_view host) {
    const std::size_t mark = name.rfind(kTemporaryMark);
    if (!name.starts_with('.') || !name.ends_with(end_of_name) || mark == std::string_view::npos) return 0;
    std::string_view rest = name.substr(mark + kTemporaryMark.size());
    rest.remove_suffix(end_of_name.size());
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
    const int descriptor = open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK);
    if (descriptor < 0) return true;
    const bool locked = flock(descriptor, LOCK_EX | LOCK_NB) != 0;
    close(descriptor);
    return locked;
}

/// Names of files or folders in `folder` that killed processes of this host left there.
std::vector<fs::path> stale_temporaries(const fs::path& folder, std::string_view end_of_name,
                                        fs::file_type type) {
    std::vector<fs::path> stale;
    const std::string host = host_mark();
    std::error_code failure;
    for (fs::directory_iterator at(folder.empty() ? fs::path(".") : folder, failure), end;
         !failure && at != end; at.increment(failure)) {
        const pid_t maker = maker_of_temporary(at->path().filename().string(), end_of_name, host);
        std::error_code ignored;
        if (maker != 0 && !is_running(maker) && at->symlink_status(ignored).type() == type &&
            !is_locked(at->path()))
            stale.push_back(at->path());
    }
    std::sort(stale.begin(), stale.end());
    return stale;
}

/// Where a process writes many files into a folder, looking once is enough.
void clear_once(const fs::path& folder) {
    static std::mutex mutex;
    static std::set<fs::path> cleared;
    const std::scoped_lock lock(mutex);
    if (cleared.insert(folder).second) remove_stale_temporaries(folder);
}

/// What writing to a path reaches.
struct Target {
    fs::path path;           ///< at the end of the links
    bool is_direct = false;  ///< a pipe, a socket, a device, or an open file of a process: no rename there
};

Target target_of(const fs::path& named) {
    constexpr int kMostLinks = 40;  // as the kernel's
    fs::path at = named;
    std::error_code failure;
    for (int links = 0; links < kMostLinks; ++links) {
        if (!fs::is_symlink(fs::symlink_status(at, failure))) {
            const fs::file_type type = fs::status(at, failure).type();
            return {at, type == fs::file_type::fifo || type == fs::file_type::socket ||
                            type == fs::file_type::character || type == fs::file_type::block};
        }
        // /dev/stdout leads here; what /proc says that its links lead to may be no path at all.
        if (at.string().starts_with("/proc/")) return {at, true};
        const fs::path to = fs::read_symlink(at, failure);
        at = to.is_absolute() ? to : at.parent_path() / to;
    }
    return {named, false};  // a ring, which nothing can open
}

constexpr const char* kNotRegular = "is not a regular file";
constexpr const char* kAbsent = "no such file";

}  // namespace

AtomicFile::AtomicFile(fs::path final_path) : final_path_(std::move(final_path)) {
    const Target target = target_of(final_path_);
    if (target.is_direct)
        throw Error(ErrorKind::output,
                    final_path_.string() +
                        ": is a pipe, a socket or a device, and this file is made beside its "
                        "place and renamed (name a regular file)");
    target_ = target.path;
    std::error_code failure;
    const fs::file_status old = fs::symlink_status(target_, failure);
    if (fs::is_symlink(old)) {
        temporary_path_ = target_;  // a ring of links: whoever opens it gets the reason
        return;
    }
    if (fs::is_regular_file(old)) kept_ = old.permissions() & fs::perms::all;
    clear_once(target_.parent_path());
    // New files as fopen() makes them: less the user's umask. What replaces a private file is private already
    // while it is written.
    constexpr mode_t kMode = 0666, kOwner = 0600;
    const mode_t mode = kept_ ? mode_t(*kept_) | kOwner : kMode;
    // What has the name already is of a process of that number, or planted.
    constexpr int kMostTries = 1000;
    for (int i = 0; i == 0 || (lock_ < 0 && errno == EEXIST && i < kMostTries); ++i) {
        temporary_path_ = temporary_name(target_, kTemporaryEnd);
        lock_ = open(temporary_path_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, mode);
    }
    if (lock_ < 0 && errno == EEXIST)
        throw Error(ErrorKind::output, final_path_.string() +
                                           ": every temporary name beside it is taken (remove " +
                                           temporary_path_.filename().string() + " and the like)");
    if (lock_ >= 0) flock(lock_, LOCK_EX | LOCK_NB);
}

AtomicFile::~AtomicFile() {
    if (lock_ >= 0) close(lock_);
    if (committed_ || temporary_path_ == target_) return;
    std::error_code ignored;
    fs::remove(temporary_path_, ignored);
}

std::vector<fs::path> remove_stale_temporaries(const fs::path& folder) {
    std::vector<fs::path> removed = stale_temporaries(folder, kTemporaryEnd, fs::file_type::regular);
    std::error_code ignored;
    std::erase_if(removed, [&](const fs::path& path) { return !fs::remove(path, ignored); });
    return removed;
}

AtomicFolder::AtomicFolder(fs::path final_path) : final_path_(std::move(final_path)) {
    std::error_code failure;
    fs::create_directories(final_path_.parent_path(), failure);
    for (const fs::path& stale :
         stale_temporaries(final_path_.parent_path(), kTemporaryFolderEnd, fs::file_type::directory))
        fs::remove_all(stale, failure);
    constexpr mode_t kMode = 0777;  // less the user's umask
    // What has the name already is of an earlier process of that number, as containers have, or was planted.
    constexpr int kMostTries = 1000;
    int failed = 0;
    for (int i = 0; i == 0 || (failed && errno == EEXIST && i < kMostTries); ++i) {
        temporary_path_ = temporary_name(final_path_, kTemporaryFolderEnd);
        failed = mkdir(temporary_path_.c_str(), kMode);
    }
    if (failed)
        throw Error(ErrorKind::output, final_path_.string() + ": cannot be made: " + std::strerror(errno));
    lock_ = open(temporary_path_.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (lock_ >= 0) flock(lock_, LOCK_EX | LOCK_NB);
}

AtomicFolder::~AtomicFolder() {
    if (lock_ >= 0) close(lock_);
    if (committed_) return;
    std::error_code ignored;
    fs::remove_all(temporary_path_, ignored);
}

void AtomicFolder::commit() {
    int failed =
        renameat2(AT_FDCWD, temporary_path_.c_str(), AT_FDCWD, final_path_.c_str(), RENAME_NOREPLACE);
    // Where the file system cannot say so, a folder that holds something is not replaced either.
    if (failed && errno == EINVAL) failed = std::rename(temporary_path_.c_str(), final_path_.c_str());
    if (failed)
        throw Error(ErrorKind::output, final_path_.string() + ": cannot be made: " + std::strerror(errno));
    committed_ = true;
}

void prepare_output_folder(const fs::path& file) {
    const Target target = target_of(file);
    if (file.empty() || target.is_direct) return;
    const fs::path folder = target.path.has_parent_path() ? target.path.parent_path() : fs::path(".");
    const auto refuse = [&](const std::string& what) {
        throw Error(ErrorKind::output, file.string() + ": " + what);
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

void AtomicFile::copy_from(const fs::path& file) {
    const auto fail = [&](const std::string& step) {
        throw Error(ErrorKind::output, final_path_.string() + ": " + step + ": " + std::strerror(errno));
    };
    // fs::copy_file() would also give the copy the permissions of `file`.
    const Descriptor from(open(file.c_str(), O_RDONLY | O_CLOEXEC));
    if (from.get() < 0) fail("'" + file.string() + "' cannot be read");
    const Descriptor to(open(temporary_path_.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666));
    ssize_t count = to.get() < 0 ? -1 : 1;
    while (count > 0) count = sendfile(to.get(), from.get(), nullptr, std::size_t(1) << 30);
    if (count < 0) fail("cannot be written");
}

void AtomicFile::commit(Flush flush) {
    const auto fail = [&](const char* step) {
        throw Error(ErrorKind::output, final_path_.string() + ": " + step + ": " + std::strerror(errno));
    };
    const int file = open(temporary_path_.c_str(), O_RDONLY | O_CLOEXEC);
    if (file < 0) fail("cannot open the written file");
    // Some file systems have no permissions to keep.
    if (kept_ && fchmod(file, mode_t(*kept_)) != 0 && errno != EPERM && errno != ENOTSUP) {
        close(file);
        fail("cannot keep the permissions");
    }
    const int flushed = flush == Flush::yes ? fsync(file) : 0;
    close(file);
    if (flushed != 0) fail("cannot flush to disk");
    if (std::rename(temporary_path_.c_str(), target_.c_str()) != 0) fail("cannot rename into place");
    committed_ = true;
}

namespace {

/// A pipe is opened without waiting for its reader, and written to with waiting. An open file of this process
/// is not opened again: two positions in one file would write over each other.
int open_directly(const fs::path& path) {
    constexpr std::string_view kOwnFiles = "/proc/self/fd/";
    const std::string text = path.string();
    int number = 0;
    const char* const end = text.data() + text.size();
    if (text.starts_with(kOwnFiles) &&
        std::from_chars(text.data() + kOwnFiles.size(), end, number).ptr == end) {
        std::fflush(nullptr);  // what was printed before comes first
        return fcntl(number, F_DUPFD_CLOEXEC, 0);
    }
    const int file = open(path.c_str(), O_WRONLY | O_APPEND | O_NONBLOCK | O_CLOEXEC);
    if (file >= 0) fcntl(file, F_SETFL, fcntl(file, F_GETFL) & ~O_NONBLOCK);
    return file;
}

void write_directly(const fs::path& path, std::string_view text) {
    const auto fail = [&](const std::string& why) {
        throw Error(ErrorKind::output, path.string() + ": cannot be written: " + why);
    };
    const int file = open_directly(path);
    if (file < 0) fail(errno == ENXIO ? "it is a pipe without a reader" : std::strerror(errno));
    int failure = 0;
    while (!text.empty() && failure == 0) {
        const ssize_t written = write(file, text.data(), text.size());
        if (written >= 0) text.remove_prefix(std::size_t(written));
        else if (errno != EINTR) failure = errno;
    }
    close(file);
    if (failure != 0) fail(std::strerror(failure));
}

}  // namespace

void write_text_file(const fs::path& path, std::string_view text) {
    if (const Target target = target_of(path); target.is_direct) return write_directly(target.path, text);
    AtomicFile file(path);
    errno = 0;
    std::ofstream out(file.temporary_path(), std::ios::binary);
    out << text;
    out.close();
    if (!out)
        throw Error(ErrorKind::output,
                    path.string() + ": cannot be written: " + std::strerror(errno ? errno : EIO));
    file.commit();
}

std::string read_regular_file(const fs::path& path, std::uintmax_t max_bytes, std::string& fault) {
    fault.clear();
    // Without O_NONBLOCK a pipe would wait for a writer. What is opened is what is judged.
    const Descriptor file(open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC));
    struct stat status;
    if (file.get() < 0 || fstat(file.get(), &status) != 0) {
        fault = errno == ENOENT ? kAbsent : std::string("cannot be read: ") + std::strerror(errno);
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
    while ((count = read(file.get(), buffer.data(), buffer.size())) > 0) {
        text.append(buffer.data(), std::size_t(count));
        if (text.size() > max_bytes) return too_large(text.size());
    }
    if (count == 0) return text;
    fault = std::string("cannot be read: ") + std::strerror(errno);
    return "";
}

std::string read_text_file(const fs::path& path, ErrorKind code, std::uintmax_t max_bytes) {
    std::string fault;
    std::string text = read_regular_file(path, max_bytes, fault);
    if (!fault.empty()) throw Error(code, path.string() + ": " + fault);
    return text;
}

bool replace_text_file(const fs::path& path, std::string_view before, std::string_view text) {
    // A file's own lock would go with the file that is replaced. Any reader of the folder can hold this one.
    const fs::path folder = target_of(path).path.parent_path();
    const Descriptor lock(open(folder.empty() ? "." : folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
    constexpr int kMostTries = 50;
    constexpr useconds_t kPause_us = 10'000;
    for (int i = 0; flock(lock.get(), LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK; ++i) {
        if (i == kMostTries)
            throw Error(ErrorKind::output,
                        path.string() + ": another program has held the lock of its folder '" +
                            folder.string() + "' for half a second; nothing was written (try again)");
        usleep(kPause_us);
    }
    std::string fault;
    const std::string found = read_regular_file(path, kMaxTextFileBytes, fault);
    if (fault.empty() && found != before) return false;
    if (!fault.empty() && fault != kAbsent)
        throw Error(ErrorKind::output, path.string() + ": " + fault + "; nothing was written");
    write_text_file(path, text);
    return true;
}

bool file_begins_with(const fs::path& path, std::string_view bytes) {
    const Descriptor file(open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC));
    struct stat status;
    std::string begin(bytes.size(), '\0');
    return file.get() >= 0 && fstat(file.get(), &status) == 0 && S_ISREG(status.st_mode) &&
           pread(file.get(), begin.data(), begin.size(), 0) == ssize_t(bytes.size()) && begin == bytes;
}

}  // namespace aftershade
