// Histories saved during a run, so that a killed run loses few frames.
#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "framework/run/run_state.h"

namespace aftershade {

/// The checkpoints of the frames of one run; chunks of other frames may keep theirs in the same folder. [one
/// thread at a time]
class Checkpoints {
public:
    Checkpoints(const RunState& state, std::vector<int> frames);

    /// Where the history after that frame is kept.
    std::filesystem::path file(int frame) const;
    /// Whether there is a whole one, saved with that fingerprint.
    bool holds(int frame, const std::string& fingerprint) const;
    /// Places in the run of the frames that have one, latest first.
    std::vector<std::size_t> saved() const;
    /// The same, to be written: makes the folder. Throws Error(ErrorKind::output).
    std::filesystem::path writable(int frame) const;
    /// Keeps those of the two latest frames in the order of the run.
    void drop_old() const;
    void drop_all() const;

private:
    std::string name_of(int frame) const;
    std::filesystem::path folder() const;  // "" where it lies behind a link

    std::filesystem::path base_;
    std::string name_;  // of the folder, below it
    std::vector<int> frames_;
    std::map<int, std::size_t> places_;  // in the run, by frame
};

}  // namespace aftershade
