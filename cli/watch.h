// Whether files that a picture is made of have changed: for `run --watch`.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <utility>
#include <vector>

#include "framework/look/look.h"
#include "framework/look/pipeline.h"

namespace aftershade::cli {

/// Looks at times and sizes: editors replace files in more ways than notifications report alike, and a few
/// dozen files cost microseconds.
class FileWatch {
public:
    /// `paths` are files, and folders whose files count.
    explicit FileWatch(std::vector<std::filesystem::path> paths) : paths_(std::move(paths)), seen_(look()) {}

    /// Whether anything is other than at the last call.
    bool changed();
    const std::vector<std::filesystem::path>& paths() const { return paths_; }

private:
    struct State {
        std::filesystem::file_time_type time{};
        std::uintmax_t bytes = 0;
        bool operator==(const State&) const = default;
    };
    using States = std::map<std::filesystem::path, State>;
    States look() const;

    std::vector<std::filesystem::path> paths_;
    States seen_;
};

/// The look, the looks that it uses, and the folders of its effects, of modules and of shared shaders.
std::vector<std::filesystem::path> paths_to_watch(const Look& look, const Pipeline& pipeline,
                                                  const std::filesystem::path& data_folder);

}  // namespace aftershade::cli
