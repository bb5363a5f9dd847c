#include "cli/watch.h"

#include <utility>

namespace aftershade::cli {

namespace fs = std::filesystem;

FileWatch::States FileWatch::look() const {
    States states;
    std::error_code failure;
    const auto add = [&](const fs::path& file) {
        states[file] = {fs::last_write_time(file, failure), fs::file_size(file, failure)};
    };
    for (const fs::path& path : paths_) {
        if (!fs::is_directory(path, failure)) add(path);
        else
            for (const auto& entry : fs::directory_iterator(path, failure))
                if (entry.is_regular_file(failure)) add(entry.path());
    }
    return states;
}

bool FileWatch::changed() {
    States now = look();
    const bool differs = now != seen_;
    seen_ = std::move(now);
    return differs;
}

std::vector<fs::path> paths_to_watch(const Look& look, const Pipeline& pipeline,
                                     const fs::path& data_folder) {
    std::vector<fs::path> paths = look.files;
    for (const PipelineStep& step : pipeline.steps) paths.push_back(step.manifest->folder);
    const fs::path glsl = data_folder / "glsl";
    paths.push_back(glsl);
    std::error_code failure;
    for (const auto& entry : fs::directory_iterator(glsl, failure))
        if (entry.is_directory(failure)) paths.push_back(entry.path());
    return paths;
}

}  // namespace aftershade::cli
