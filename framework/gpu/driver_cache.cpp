#include "framework/gpu/driver_cache.h"

#include <fcntl.h>
#include <pwd.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <filesystem>
#include <fstream>
#include <optional>
#include <thread>
#include <vector>

#include "framework/base/error.h"
#include "framework/base/side_file.h"
#include "framework/base/text.h"

namespace aftershade::gpu {
namespace {

namespace fs = std::filesystem;

// What follows is as in Mesa's src/util/disk_cache_os.c, versions 22 to 25.

constexpr const char* kDefaultFolder = "mesa_shader_cache";
constexpr const char* kOtherFolders[] = {"mesa_shader_cache_db", "mesa_shader_cache_sf"};
constexpr off_t kIndexBytes = 8 + 65536 * 20;  // the cache's size, and keys
/// A file of one shader, which is only read, replaced and removed; others are written in place.
constexpr std::size_t kShaderNameLength = 38;
constexpr std::size_t kShaderFolderNameLength = 2;  // of the 256 folders that hold these files

bool is_disabled() {
    for (const char* name : {"MESA_SHADER_CACHE_DISABLE", "MESA_GLSL_CACHE_DISABLE"})
        if (const char* value = std::getenv(name)) {
            const std::string word = lower_case(value);
            return word != "0" && word != "n" && word != "no" && word != "f" && word != "false";
        }
    return false;
}

/// "" where there is none.
fs::path folder_of_caches() {
    for (const char* name : {"MESA_SHADER_CACHE_DIR", "MESA_GLSL_CACHE_DIR", "XDG_CACHE_HOME"})
        if (const char* value = std::getenv(name)) return value;
    passwd entry{};
    passwd* found = nullptr;
    std::vector<char> buffer(16384);
    getpwuid_r(getuid(), &entry, buffer.data(), buffer.size(), &found);
    return found ? fs::path(found->pw_dir) / ".cache" : fs::path();
}

/// Whether this user alone can have put anything there.
bool is_private(const fs::path& folder) {
    struct stat status = {};
    return lstat(folder.c_str(), &status) == 0 && status.st_uid == geteuid() &&
           (status.st_mode & (S_IWGRP | S_IWOTH)) == 0;
}

/// Links, pipes, devices, and second names of files that are written in place. A cache of 50,000 shaders
/// takes 20 ms to read, so private folders of shaders are left out.
std::string planted_below(const fs::path& folder) {
    std::error_code failure;
    for (fs::recursive_directory_iterator
             entry(folder, fs::directory_options::skip_permission_denied, failure),
         end;
         !failure && entry != end; entry.increment(failure)) {
        std::error_code gone;  // other processes write here too
        const std::string& path = entry->path().native();
        if (entry->is_symlink(gone))
            return path + ": is a symbolic link, which is not followed here (remove it)";
        if (entry->is_directory(gone)) {
            const bool is_of_shaders = entry->path().filename().native().size() == kShaderFolderNameLength;
            if (is_of_shaders && is_private(entry->path())) entry.disable_recursion_pending();
            continue;
        }
        if (!entry->is_regular_file(gone) && !gone && entry->exists(gone))
            return path + ": is not a regular file (remove it)";
        if (path.size() - path.rfind('/') - 1 != kShaderNameLength && entry->hard_link_count(gone) > 1 &&
            !gone)
            return path + ": has a second name, a hard link, under which it would change too (remove it)";
    }
    return "";
}

/// What keeps all of the index from having room on the disk.
std::string index_fault(const fs::path& folder, const fs::path& name) {
    std::string fault;
    const std::optional<OpenFile> index = open_file_below(folder, name, fault, FileUse::update);
    struct stat status = {};
    if (index && fstat(index->descriptor(), &status) == 0) {
        constexpr off_t kBlock = 512;  // of st_blocks
        const off_t bytes = std::max(kIndexBytes, status.st_size);
        const bool is_whole = status.st_size == bytes && status.st_blocks * kBlock >= bytes;
        if (const int failed = is_whole ? 0 : posix_fallocate(index->descriptor(), 0, bytes))
            fault = "finds no room for its " + std::to_string(bytes) + " bytes: " + std::strerror(failed) +
                    " (make room, or choose another folder with AFTERSHADE_CACHE)";
    }
    return fault.empty() ? "" : (folder / name).string() + ": " + fault;
}

std::string cache_fault() {
    const fs::path folder = folder_of_caches();
    if (folder.empty()) return "";
    std::error_code failure;
    fs::create_directories(folder, failure);
    try {
        make_folder_below(folder, kDefaultFolder);
        std::string fault = index_fault(folder, fs::path(kDefaultFolder) / "index");
        if (fault.empty()) fault = planted_below(folder / kDefaultFolder);
        for (const char* other : kOtherFolders) {
            if (!fault.empty() || !fs::exists(path_below(folder, other))) continue;
            fault = planted_below(folder / other);
            if (fault.empty() && fs::exists(folder / other / "index"))
                fault = index_fault(folder, fs::path(other) / "index");
        }
        return fault;
    } catch (const std::exception& error) {
        return error.what();
    }
}

bool some_thread_writes() {
    for (const auto& task : fs::directory_iterator("/proc/self/task")) {
        std::ifstream file(task.path() / "stat");
        std::string stat;
        if (std::getline(file, stat) && is_writing_driver_cache(stat)) return true;
    }
    return false;
}

}  // namespace

const std::string& prepare_driver_cache() {
    static const std::string fault = [] {
        std::string found = is_disabled() ? "" : cache_fault();
        if (!found.empty()) setenv("MESA_SHADER_CACHE_DISABLE", "true", 1);
        return found;
    }();
    return fault;
}

bool is_writing_driver_cache(std::string_view stat) {
    // The name may hold brackets itself; the state follows the last one.
    const std::size_t end = stat.rfind(')');
    if (end == std::string_view::npos || end + 2 >= stat.size()) return false;
    const char state = stat[end + 2];
    return stat.substr(0, end).find(":disk$") != std::string_view::npos && (state == 'R' || state == 'D');
}

void wait_for_driver_cache() noexcept {
    using namespace std::chrono_literals;
    try {
        for (int i = 0; i < 100 && some_thread_writes(); ++i) std::this_thread::sleep_for(500us);
    } catch (const std::exception&) {
        // No /proc.
    }
}

}  // namespace aftershade::gpu
