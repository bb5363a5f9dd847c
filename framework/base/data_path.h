// Where the shipped effects, GLSL modules and profiles lie.
#pragma once

#include <filesystem>

namespace aftershade {

/// $AFTERSHADE_DATA, else the source tree when the executable runs from its build tree, else
/// <prefix>/share/aftershade beside the executable's bin folder. Throws Error(ErrorKind::usage) naming the
/// places tried when none of them holds `effects`.
/// Inside a DataPathScope of this thread: its folder.
std::filesystem::path data_path();

/// While it lives, data_path() of this thread is `folder`: for callers that bring the shipped data along.
/// They nest. [the thread that made it]
class DataPathScope {
public:
    /// `folder` must outlive the scope.
    explicit DataPathScope(const std::filesystem::path& folder);
    ~DataPathScope();
    DataPathScope(const DataPathScope&) = delete;
    DataPathScope& operator=(const DataPathScope&) = delete;

private:
    const std::filesystem::path* before_;
};

}  // namespace aftershade
