#include "framework/base/side_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <utility>

#include "framework/base/child_process.h"
#include "framework/base/error.h"

namespace aftershade {

namespace fs = std::filesystem;

namespace {

constexpr const char* kNotFollowed =
    "a symbolic link, which is not followed here (remove it, or put the file itself in its place)";

std::string system_fault(const char* what) {
    return errno == ENOENT ? kNoSuchFile : std::string(what) + ": " + std::strerror(errno);
}

enum class Absent { fails, is_made };

/// The folder that holds the last part of `name`; none where `fault` says why.
Descriptor open_parent(const fs::path& folder, const fs::path& name, Absent absent, std::string& fault) {
    fault.clear();
    const auto fail = [&](const std::string& why) {
        fault = why;
        return Descriptor();
    };
    if (name.empty() || name.is_absolute()) return fail("leads out of its folder");
    Descriptor at(open(folder.empty() ? "." : folder.c_str(), O_PATH | O_DIRECTORY | O_CLOEXEC));
    if (at.get() < 0) return fail(system_fault("cannot be reached"));
    fs::path reached = folder;
    for (const fs::path& part : name.parent_path()) {
        reached /= part;
        if (part == "..") return fail("leads out of its folder");
        constexpr mode_t kMode = 0777;  // less the user's umask
        if (absent == Absent::is_made && mkdirat(at.get(), part.c_str(), kMode) != 0 && errno != EEXIST)
            return fail(system_fault("cannot be made"));
        Descriptor next(openat(at.get(), part.c_str(), O_PATH | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC));
        struct stat status = {};
        if (next.get() < 0 && errno == ENOTDIR &&
            fstatat(at.get(), part.c_str(), &status, AT_SYMLINK_NOFOLLOW) == 0 && S_ISLNK(status.st_mode))
            return fail("lies behind '" + reached.string() + "', " + kNotFollowed);
        if (next.get() < 0) return fail(system_fault("cannot be reached"));
        at = std::move(next);
    }
    return at;
}

int flags_of(FileUse use) {
    switch (use) {
        case FileUse::read: return O_RDONLY;
        case FileUse::append: return O_RDWR | O_APPEND | O_CREAT;
        case FileUse::update: return O_RDWR | O_CREAT;
    }
    return O_RDONLY;
}

}  // namespace

std::optional<OpenFile> open_file_below(const fs::path& folder, const fs::path& name, std::string& fault,
                                        FileUse use) {
    const fs::path normal = name.lexically_normal();
    const Descriptor parent = open_parent(folder, normal, Absent::fails, fault);
    if (!fault.empty()) return std::nullopt;
    const std::string leaf = normal.filename().string();
    struct stat status = {};
    // Opening a device can do something; not to block, a pipe would wait for a writer.
    const bool is_there = fstatat(parent.get(), leaf.c_str(), &status, AT_SYMLINK_NOFOLLOW) == 0;
    if (is_there && S_ISLNK(status.st_mode)) fault = std::string("is ") + kNotFollowed;
    else if (is_there && !S_ISREG(status.st_mode)) fault = "is not a regular file (remove it)";
    if (!fault.empty()) return std::nullopt;
    constexpr mode_t kMode = 0666;  // less the user's umask
    OpenFile file(folder / name, openat(parent.get(), leaf.c_str(),
                                        flags_of(use) | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC, kMode));
    if (file.descriptor() < 0)
        fault = errno == ELOOP ? std::string("is ") + kNotFollowed : system_fault("cannot be opened");
    else if (fstat(file.descriptor(), &status) != 0 || !S_ISREG(status.st_mode))
        fault = "is not a regular file (remove it)";
    else if (use != FileUse::read && status.st_nlink > 1)
        fault = "has a second name, a hard link, under which it would change too (remove it)";
    return fault.empty() ? std::optional(std::move(file)) : std::nullopt;
}

std::string read_file_below(const fs::path& folder, const fs::path& name, std::uintmax_t max_bytes,
                            std::string& fault) {
    const std::optional<OpenFile> file = open_file_below(folder, name, fault);
    std::string bytes;
    std::array<char, 65536> buffer;
    while (file && fault.empty()) {
        const ssize_t count = read(file->descriptor(), buffer.data(), buffer.size());
        if (count == 0) return bytes;
        if (count > 0) bytes.append(buffer.data(), std::size_t(count));
        else if (errno != EINTR) fault = std::string("cannot be read: ") + std::strerror(errno);
        if (bytes.size() > max_bytes)
            fault = "the file has more bytes than the limit of " + std::to_string(max_bytes);
    }
    return "";
}

fs::path path_below(const fs::path& folder, const fs::path& name) {
    std::string fault;
    const Descriptor parent = open_parent(folder, name.lexically_normal(), Absent::fails, fault);
    struct stat status = {};
    if (fault.empty() && fstatat(parent.get(), name.filename().c_str(), &status, AT_SYMLINK_NOFOLLOW) == 0 &&
        S_ISLNK(status.st_mode))
        fault = std::string("is ") + kNotFollowed;
    // What is absent is the writer's to make, or to report.
    if (!fault.empty() && fault != kNoSuchFile)
        throw Error(ErrorKind::output, (folder / name).string() + ": " + fault);
    return folder / name;
}

fs::path make_folder_below(const fs::path& folder, const fs::path& name) {
    std::string fault;
    open_parent(folder, name / "file", Absent::is_made, fault);
    if (!fault.empty()) throw Error(ErrorKind::output, (folder / name).string() + ": " + fault);
    return folder / name;
}

}  // namespace aftershade
