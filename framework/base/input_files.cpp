#include "framework/base/input_files.h"

#include <sys/stat.h>

#include <system_error>
#include <utility>

namespace aftershade {

namespace fs = std::filesystem;

namespace {

fs::path canonical_path(const fs::path& path) {
    std::error_code failure;
    const fs::path result = fs::weakly_canonical(fs::absolute(path, failure), failure);
    return failure ? path : result;
}

}  // namespace

const InputFiles::Folder& InputFiles::folder_of(const std::string& text) const {
    const auto known = folders_.find(text);
    if (known != folders_.end()) return known->second;
    Folder folder;
    folder.path = canonical_path(text).native();
    if (!folder.path.ends_with('/')) folder.path += '/';
    std::error_code failure;
    for (fs::directory_iterator at(text, failure), end; !failure && at != end; at.increment(failure))
        folder.names.insert(at->path().filename().native());
    return folders_.emplace(text, std::move(folder)).first->second;
}

InputFiles::Found InputFiles::find(const fs::path& path) const {
    const std::string& text = path.native();
    const std::size_t slash = text.rfind('/');
    const std::string name = slash == std::string::npos ? text : text.substr(slash + 1);
    const bool is_plain = !name.empty() && name != "." && name != "..";
    struct stat status = {};
    if (is_plain) {
        const Folder& folder = folder_of(slash == std::string::npos ? "." : text.substr(0, slash + 1));
        if (!folder.names.contains(name) || lstat(path.c_str(), &status) != 0)
            return {std::nullopt, true, folder.path + name};
    }
    const std::string resolved = canonical_path(path).native();
    if (stat(path.c_str(), &status) != 0) return {std::nullopt, true, resolved};
    const bool is_file = S_ISREG(status.st_mode);
    const Identity identity{std::uint64_t(status.st_dev), std::uint64_t(status.st_ino)};
    return {is_file ? std::optional(identity) : std::nullopt, is_file, resolved};
}

void InputFiles::add(const fs::path& file) {
    if (file.empty()) return;
    Found found = find(file);
    if (found.identity) by_identity_.emplace(*found.identity, file);
    else by_path_.emplace(std::move(found.path), file);
}

void InputFiles::add(std::span<const fs::path> files) {
    for (const fs::path& file : files) add(file);
}

std::optional<fs::path> InputFiles::input_at(const Found& output) const {
    if (output.identity) {
        const auto input = by_identity_.find(*output.identity);
        return input == by_identity_.end() ? std::nullopt : std::optional(input->second);
    }
    const auto input = by_path_.find(output.path);
    return input == by_path_.end() ? std::nullopt : std::optional(input->second);
}

std::optional<fs::path> InputFiles::replaced_by(const fs::path& output) const {
    return input_at(find(output));
}

bool InputFiles::check_output(const Place& place, const fs::path& output, Diagnostics& diagnostics) {
    if (output.empty()) return true;
    Found found = find(output);
    if (const auto input = input_at(found)) {
        diagnostics.error(place, "would replace the input " + input->string());
        return false;
    }
    // Any number of outputs may go to one pipe or to /dev/null.
    if (found.is_file && !outputs_.insert(std::move(found.path)).second) {
        diagnostics.error(place, "another output has this name");
        return false;
    }
    return true;
}

}  // namespace aftershade
