#include "framework/serve/file_name.h"

#include <algorithm>
#include <system_error>

namespace aftershade::serve {

std::filesystem::path new_path(const std::filesystem::path& folder, const std::string& name,
                               const std::string& ending, const std::string& thing) {
    constexpr std::size_t kLongestName = 200;  // bytes; file systems take 255 with what AtomicFile adds
    if (name.empty()) throw Refusal{400, thing + " has no name yet: type one"};
    const bool has_control = std::ranges::any_of(name, [](unsigned char c) { return c < 32 || c == 127; });
    if (name.size() > kLongestName || name.front() == '.' || has_control ||
        name.find('/') != std::string::npos)
        throw Refusal{400, "'" + name + "' is not a name for " + thing +
                               ": use at most 200 bytes without '/', and no '.' in front"};
    std::filesystem::path path = folder / (name.ends_with(ending) ? name : name + ending);
    std::error_code failure;
    if (std::filesystem::symlink_status(path, failure).type() != std::filesystem::file_type::not_found)
        throw Refusal{409, path.string() + " is there already; choose another name"};
    return path;
}

}  // namespace aftershade::serve
