// A folder for files of the moment.
#pragma once

#include <filesystem>

namespace aftershade {

/// A new folder where the system keeps temporary files; it goes away with everything in it.
class ScratchFolder {
public:
    /// Throws Error(ErrorKind::output).
    ScratchFolder();
    ~ScratchFolder();
    ScratchFolder(const ScratchFolder&) = delete;
    ScratchFolder& operator=(const ScratchFolder&) = delete;
    const std::filesystem::path& path() const { return path_; }

private:
    std::filesystem::path path_;
};

}  // namespace aftershade
