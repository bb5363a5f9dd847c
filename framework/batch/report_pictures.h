// The pictures of a report, DIR/images, and which of the files there are its own.
#pragma once

#include <filesystem>
#include <mutex>
#include <set>
#include <string>

namespace aftershade {

/// Recognises files by a list of the names that reports have written here, DIR/images/.pictures. A name alone
/// would not do: "shot.0001.reference.exr" may be anybody's; nor would the report.json of an earlier run,
/// which a run that was killed has not written.
class ReportPictures {
public:
    /// Makes the folder. Throws Error(ErrorKind::output) where it cannot be made, or its list cannot be read.
    explicit ReportPictures(std::filesystem::path folder);

    const std::filesystem::path& folder() const { return folder_; }

    /// Where to write the picture of that file name. It is listed before it exists, in case the
    /// process ends. Throws Error(ErrorKind::output). [thread-safe]
    std::filesystem::path add(const std::string& name);

    /// Removes the pictures of earlier runs that this one has not written again; files in no list stay.
    /// Throws Error(ErrorKind::output).
    void remove_old();

private:
    std::filesystem::path folder_;
    std::mutex mutex_;
    std::set<std::string> old_;  // of runs before this one
    std::set<std::string> own_;
};

}  // namespace aftershade
