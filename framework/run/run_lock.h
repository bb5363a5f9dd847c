// So that two runs never write the same frames of one output at a time.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace aftershade {

/// Waits for the whole of an open file; closing it lets it go. Whether the file system can lock.
bool lock_whole_file(int file);

/// Holds frames of one output pattern while it lives. Runs on other frames of the pattern, such as the chunks
/// of a farm, and runs on other patterns do not disturb each other. The system lets the frames go when the
/// process ends, however it ends. A file ".aftershade/lock-<hash>" says who holds which frames; it goes with
/// the last holder.
class RunLock {
public:
    /// `command` is for messages. Throws Error(ErrorKind::output) where another run holds one of the frames,
    /// naming its process, host, start and frames, and where the folder cannot be written.
    RunLock(const std::string& pattern, std::vector<int> frames, const std::string& command);
    ~RunLock();
    RunLock(const RunLock&) = delete;
    RunLock& operator=(const RunLock&) = delete;

    /// False on a file system without locks: nothing is held then.
    bool is_held() const { return held_; }

private:
    void open_file();
    bool take(const std::vector<int>& frames);
    bool lock_frames(int first, int last);
    void add_holder(const std::vector<int>& frames, const std::string& command);

    std::filesystem::path folder_;
    std::string name_;  // below it
    std::string pattern_;
    std::string holder_;  // this run's line
    int file_ = -1;
    bool held_ = true;
};

}  // namespace aftershade
