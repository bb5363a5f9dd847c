// A run that leaves out what an earlier one has written and what is still current.
#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "framework/run/checkpoints.h"
#include "framework/run/fingerprint.h"
#include "framework/run/journal.h"
#include "framework/run/run_frames.h"

namespace aftershade {

enum class FrameAction {
    leave,   ///< current
    render,  ///< current, but a frame to be written needs what it leaves: history, or a picture to hold
    write
};

struct PlannedFrame {
    int frame = 0;
    FrameAction action = FrameAction::write;
    std::string reason;  ///< of `write`: "input gbuffer_0012.exr changed", "not rendered yet"
};

struct ResumeOptions {
    std::string overwrite;       ///< why every frame is rendered, whatever the journal says; "" to leave out
    int checkpoint_frames = 10;  ///< the history is saved every this many frames; 0: never
    bool needs_last = false;     ///< the last frame must be rendered, though not written: --graph
};

/// [one thread at a time, but hooks as RunHooks says; refers to what the caller keeps]
class ResumableRun {
public:
    /// Reads the journal beside the first output and decides on every frame. Writes nothing. Throws
    /// Error(ErrorKind::usage) for a file of the look that cannot be read, Error(ErrorKind::output) for a
    /// journal that cannot be.
    ResumableRun(const FingerprintSource& source, const CaptureReader& reader, const ResumeOptions& options);

    /// With the frames that only warm history up, which come first.
    const std::vector<PlannedFrame>& plan() const { return plan_; }
    int count(FrameAction action) const;  ///< without those
    int frame_count() const { return int(plan_.size()) - run_.warmup_frames; }
    /// The run over the frames that are not left alone, which goes with hooks().
    RunOptions planned_run() const;
    /// Refers to this. Journal and checkpoints are written through them.
    RunHooks hooks();
    /// Before the first frame. Throws Error(ErrorKind::output).
    void begin();
    /// After a run that has done everything: its checkpoints go.
    void finish() const { checkpoints_.drop_all(); }

private:
    void decide(std::size_t index);
    std::string reason_of_change(const JournalFrame& recorded, const FrameFingerprint& now) const;
    void add_last_frame();
    void add_history();
    void add_chain(std::size_t begin, std::size_t end);
    void add_held_frames();
    void save_checkpoint(std::size_t index, PipelineRenderer& renderer);
    bool warms_up(std::size_t index) const { return index < std::size_t(run_.warmup_frames); }
    std::size_t index_of(int frame) const { return indices_.at(frame); }

    const Pipeline& pipeline_;
    const OutputOptions& outputs_;
    RunOptions run_;
    ResumeOptions options_;
    FrameFiles files_;
    FingerprintParts setup_;
    std::string setup_hash_;
    FrameFingerprints fingerprints_;
    Journal journal_;
    Checkpoints checkpoints_;
    std::vector<PlannedFrame> plan_;
    std::map<int, std::size_t> indices_;                      // by frame
    std::map<std::size_t, std::filesystem::path> histories_;  // loaded before the frame
    std::optional<std::size_t> last_rendered_;
    int since_checkpoint_ = 0;
};

}  // namespace aftershade
