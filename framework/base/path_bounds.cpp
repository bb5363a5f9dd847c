#include "framework/base/path_bounds.h"

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

#include "framework/base/option.h"
#include "framework/base/text.h"

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
           target.string() + " (move it there" +
           advice(", or allow its folder with ", Option::allow_path, "", "") + ")";
}

bool has_detour(const fs::path& file, std::vector<fs::path> folders) {
    const auto normal = [](const fs::path& path) {
        const fs::path result = path.lexically_normal();
        return result.has_filename() ? result : result.parent_path();
    };
    std::error_code failure;
    for (const fs::path& allowed : allowed_folders()) folders.push_back(allowed);
    for (std::size_t i = 0, count = folders.size(); i < count; ++i) {
        if (folders[i].empty()) folders[i] = ".";
        folders.push_back(resolved_path(folders[i]));
        folders[i] = normal(fs::absolute(folders[i], failure));
    }
    const auto is_known = [&](const fs::path& place) {
        return std::ranges::any_of(folders, [&](const fs::path& folder) {
            return lies_in(place, folder) || lies_in(folder, place);
        });
    };
    fs::path before;
    for (const fs::path& part : fs::absolute(file, failure)) {
        if (part == ".." && !(is_known(normal(before)) && is_known(resolved_path(before)))) return true;
        before /= part;
    }
    return false;
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
