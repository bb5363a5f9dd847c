#include "framework/core/input_files.h"

#include <sys/stat.h>

#include <mutex>
#include <system_error>

namespace aftershade {

namespace fs = std::filesystem;

namespace {

fs::path canonical_path(const fs::path& path) {
    std::error_code failure;
    const fs::path result = fs::weakly_canonical(fs::absolute(path, failure), failure);
    return failure ? path : result;
}

struct Documents {
    std::mutex mutex;
    std::set<fs::path> files;
};

Documents& documents() {
    static Documents all;
    return all;
}

}  // namespace

void note_document(const fs::path& file) {
    const std::scoped_lock lock(documents().mutex);
    documents().files.insert(file);
}

InputFiles::InputFiles() {
    const std::scoped_lock lock(documents().mutex);
    for (const fs::path& file : documents().files) add(file);
}

fs::path InputFiles::resolved(const fs::path& path) const {
    std::error_code failure;
    const fs::path name = path.filename();
    if (name.empty() || name == "." || name == ".." || fs::is_symlink(path, failure)) return canonical_path(path);
    const fs::path folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
    const auto known = folders_.find(folder);
    if (known != folders_.end()) return known->second / name;
    return folders_.emplace(folder, canonical_path(folder)).first->second / name;
}

/// Of regular files alone: any number of outputs may go to one pipe or to /dev/null.
std::optional<InputFiles::Identity> InputFiles::identity_of(const fs::path& file) {
    struct stat status = {};
    if (stat(file.c_str(), &status) != 0 || !S_ISREG(status.st_mode)) return std::nullopt;
    return Identity{std::uint64_t(status.st_dev), std::uint64_t(status.st_ino)};
}

void InputFiles::add(const fs::path& file) {
    if (file.empty()) return;
    if (const auto identity = identity_of(file)) by_identity_.emplace(*identity, file);
    else by_path_.emplace(resolved(file), file);
}

void InputFiles::add(std::span<const fs::path> files) {
    for (const fs::path& file : files) add(file);
}

std::optional<fs::path> InputFiles::replaced_by(const fs::path& output) const {
    if (const auto identity = identity_of(output)) {
        const auto input = by_identity_.find(*identity);
        return input == by_identity_.end() ? std::nullopt : std::optional(input->second);
    }
    const auto input = by_path_.find(resolved(output));
    return input == by_path_.end() ? std::nullopt : std::optional(input->second);
}

bool InputFiles::check_output(const Place& place, const fs::path& output, Diagnostics& diagnostics) {
    if (output.empty()) return true;
    if (const auto input = replaced_by(output)) {
        diagnostics.error(place, "would replace the input " + input->string());
        return false;
    }
    std::error_code failure;
    const bool is_file = !fs::exists(output, failure) || fs::is_regular_file(output, failure);
    if (is_file && !outputs_.insert(resolved(output)).second) {
        diagnostics.error(place, "another output has this name");
        return false;
    }
    return true;
}

}  // namespace aftershade
