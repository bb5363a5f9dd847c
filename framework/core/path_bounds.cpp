#include "framework/core/path_bounds.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstddef>
#include <cstdlib>
#include <cstring>
#include <iterator>
#include <string_view>
#include <system_error>
#include <utility>

#include "framework/core/text.h"

namespace aftershade {

namespace fs = std::filesystem;

namespace {

constexpr const char* kVariable = "AFTERSHADE_ALLOW_PATH";

thread_local FileRule* innermost_rule = nullptr;

/// Both resolved.
bool lies_in(const fs::path& file, const fs::path& folder) {
    return std::mismatch(folder.begin(), folder.end(), file.begin(), file.end()).first == folder.end();
}

/// Whether `file` is named in `folder` itself and is no link: it lies there, wherever the folder leads. One
/// call of the system, where resolving both takes one for each of their folders.
bool stands_in(const fs::path& file, const fs::path& folder) {
    const fs::path name = file.filename();
    if (name.empty() || name == "." || name == ".." || file.parent_path() != folder) return false;
    struct stat status = {};
    return lstat(file.c_str(), &status) == 0 && S_ISREG(status.st_mode);
}

}  // namespace

FileRule::FileRule(WhyNot why_not) : why_not_(std::move(why_not)), outer_(innermost_rule) {
    innermost_rule = this;
}

FileRule::~FileRule() {
    innermost_rule = outer_;
}

std::string FileRule::why_not(const fs::path& file) {
    return innermost_rule ? innermost_rule->why_not_(file) : "";
}

fs::path resolved_path(const fs::path& path) {
    std::error_code failure;
    const fs::path result = fs::weakly_canonical(fs::absolute(path, failure), failure);
    return failure ? fs::absolute(path, failure).lexically_normal() : result;
}

std::string out_of_bounds(const fs::path& file, const fs::path& folder) {
    if (stands_in(file, folder)) return "";
    const fs::path target = resolved_path(file);
    if (lies_in(target, resolved_path(folder.empty() ? fs::path(".") : folder))) return "";
    for (const fs::path& allowed : allowed_folders())
        if (lies_in(target, resolved_path(allowed))) return "";
    return "leads out of the folder '" + (folder.empty() ? std::string(".") : folder.string()) + "', to " +
           target.string() + " (move it there, or allow its folder with --allow-path)";
}

// One folder after the other, so that no link is followed on the way either.
std::optional<OpenFile> open_file_below(const fs::path& folder, const fs::path& name, std::string& fault) {
    fault.clear();
    OpenFile at(folder / name,
                open(folder.empty() ? "." : folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
    const fs::path normal = name.lexically_normal();
    if (normal.empty() || normal.is_absolute() || *normal.begin() == "..") {
        fault = "leads out of its folder";
        return std::nullopt;
    }
    for (auto part = normal.begin(); at.descriptor() >= 0 && part != normal.end(); ++part) {
        const bool is_last = std::next(part) == normal.end();
        // Not blocking: a pipe would wait for a writer.
        const int flags = O_RDONLY | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK | (is_last ? 0 : O_DIRECTORY);
        at = OpenFile(folder / name, openat(at.descriptor(), part->c_str(), flags));
    }
    struct stat status = {};
    if (at.descriptor() < 0) {
        const bool is_link = errno == ELOOP || errno == ENOTDIR;
        fault = is_link ? "is, or lies behind, a symbolic link, which is not followed" : std::strerror(errno);
    } else if (fstat(at.descriptor(), &status) != 0 || !S_ISREG(status.st_mode)) {
        fault = "is not a regular file";
    }
    return fault.empty() ? std::optional(std::move(at)) : std::nullopt;
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

std::vector<fs::path> allowed_folders() {
    const char* const text = std::getenv(kVariable);
    std::vector<fs::path> folders;
    for (const std::string_view folder : split(text ? text : "", ':'))
        if (!folder.empty()) folders.emplace_back(folder);
    return folders;
}

void allow_folders(const std::vector<std::string>& folders) {
    const char* const before = std::getenv(kVariable);
    std::string text = before ? before : "";
    for (const std::string& folder : folders)
        text += (text.empty() ? "" : ":") + fs::absolute(folder).string();
    if (!text.empty()) setenv(kVariable, text.c_str(), 1);
}

}  // namespace aftershade
