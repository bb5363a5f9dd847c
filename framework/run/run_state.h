// Where a run keeps what it needs to resume later: the folder ".aftershade" beside its outputs.
#pragma once

#include <filesystem>
#include <string>

namespace aftershade {

struct RunState {
    std::filesystem::path folder;  ///< of the outputs
    std::string output;            ///< "shot_#.exr": the output's name, whatever the frame
    std::string key;               ///< a hash of `output`, for names of files
    std::filesystem::path state_folder() const { return folder / ".aftershade"; }
    std::filesystem::path journal() const { return folder / kJournal; }
    std::string lock() const { return ".aftershade/lock-" + key; }            ///< below `folder`
    std::string checkpoints() const { return ".aftershade/history/" + key; }  ///< likewise
    static constexpr const char* kJournal = ".aftershade/journal.jsonl";      ///< likewise
};

/// State of an output's pattern. Patterns that differ only in the number's width are the same.
RunState run_state(const std::string& pattern);

/// Makes the state folder. Throws Error(ErrorKind::output) with the remedy.
void make_state_folder(const RunState& state);

}  // namespace aftershade
