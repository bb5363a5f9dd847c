#include "framework/run/resumable_run.h"

#include <algorithm>

#include "framework/base/error.h"
#include "framework/render/history_file.h"
#include "framework/run/output.h"

namespace aftershade {

namespace fs = std::filesystem;

ResumableRun::ResumableRun(const FingerprintSource& source, const CaptureReader& reader,
                           const ResumeOptions& options)
    : pipeline_(source.pipeline),
      outputs_(source.outputs),
      run_(source.run),
      options_(options),
      files_(source.sequence, reader, source.pipeline),
      setup_(setup_parts(source, reader)),
      setup_hash_(hash_of_parts(setup_)),
      fingerprints_(setup_hash_, source.sequence, reader, source.pipeline, source.run),
      journal_(run_state(source.outputs.patterns.front())),
      checkpoints_(run_state(source.outputs.patterns.front()), source.run.frames) {
    for (std::size_t i = 0; i < run_.frames.size(); ++i) {
        indices_[run_.frames[i]] = i;
        plan_.push_back({run_.frames[i], FrameAction::write, ""});
        decide(i);
    }
    add_last_frame();
    if (pipeline_.has_history()) add_history();
    add_held_frames();
}

int ResumableRun::count(FrameAction action) const {
    return int(std::count_if(plan_.begin() + run_.warmup_frames, plan_.end(),
                             [&](const PlannedFrame& planned) { return planned.action == action; }));
}

void ResumableRun::decide(std::size_t index) {
    PlannedFrame& planned = plan_[index];
    if (warms_up(index)) {
        planned.action = FrameAction::leave;  // unless a frame behind it needs its history
        return;
    }
    const auto expected = output_files(outputs_, pipeline_.taps, planned.frame);
    const JournalFrame* recorded = journal_.find(planned.frame);
    std::error_code unreadable;
    if (run_.missing == MissingFrame::skip && files_.is_missing(planned.frame))
        planned.reason = "its input is missing: it will be skipped";
    else if (!options_.overwrite.empty()) planned.reason = options_.overwrite;
    else if (!recorded)
        planned.reason =
            fs::exists(expected.front(), unreadable)
                ? "the journal does not record how " + expected.front().filename().string() + " was made"
                : "not rendered yet";
    else if (planned.reason = journal_.fault_of_files(*recorded, expected); planned.reason.empty()) {
        const FrameFingerprint now = fingerprints_.of(index);
        if (now.hash == recorded->fingerprint.hash) planned.action = FrameAction::leave;
        else planned.reason = reason_of_change(*recorded, now);
    }
}

std::string ResumableRun::reason_of_change(const JournalFrame& recorded, const FrameFingerprint& now) const {
    const FingerprintParts* setup = journal_.setup(recorded.setup);
    if (recorded.setup != setup_hash_ && setup) return difference_of_parts(*setup, setup_);
    const std::string inputs = difference_of_parts(recorded.fingerprint.inputs, now.inputs);
    if (!inputs.empty()) return inputs;
    if (recorded.fingerprint.before != now.before)
        return "the frame before it changed, whose history it continues";
    return "it was made in another way";
}

/// The last frame leaves what --history-out and --graph ask for.
void ResumableRun::add_last_frame() {
    if (plan_.empty() || plan_.back().action != FrameAction::leave) return;
    bool needed = options_.needs_last;
    if (std::error_code unreadable; !run_.history_out.empty()) try {
            needed = needed || !fs::exists(run_.history_out, unreadable) ||
                     read_history(run_.history_out).fingerprint != fingerprints_.of(plan_.size() - 1).hash;
        } catch (const Error&) {
            needed = true;
        }
    if (needed) plan_.back().action = FrameAction::render;
}

/// Each stretch of frames that hand history on is rendered without a gap up to its last frame that is not
/// left alone.
void ResumableRun::add_history() {
    std::size_t begin = 0;
    for (std::size_t i = 1; i <= plan_.size(); ++i)
        if (i == plan_.size() || fingerprints_.begins_history(i)) {
            add_chain(begin, i);
            begin = i;
        }
}

void ResumableRun::add_chain(std::size_t begin, std::size_t end) {
    const auto is_left = [&](std::size_t i) { return plan_[i].action == FrameAction::leave; };
    std::size_t first = begin, last = end;
    while (first < end && is_left(first)) ++first;
    if (first == end) return;
    while (is_left(last - 1)) --last;
    std::size_t start = begin;
    for (const std::size_t place : checkpoints_.saved()) {
        const bool fits = options_.overwrite.empty() && place >= begin && place < first;
        if (!fits || !checkpoints_.holds(plan_[place].frame, fingerprints_.of(place).hash)) continue;
        start = place + 1;
        histories_[start] = checkpoints_.file(plan_[place].frame);
        break;
    }
    for (std::size_t i = start; i < last; ++i)
        if (is_left(i)) plan_[i].action = FrameAction::render;
}

void ResumableRun::add_held_frames() {
    for (std::size_t i = 0; i < plan_.size(); ++i) {
        const std::size_t shown = fingerprints_.shown_index(i);
        if (plan_[i].action != FrameAction::leave && plan_[shown].action == FrameAction::leave)
            plan_[shown].action = FrameAction::render;
    }
}

RunOptions ResumableRun::planned_run() const {
    RunOptions planned = run_;
    std::erase_if(planned.frames,
                  [&](int frame) { return plan_[index_of(frame)].action == FrameAction::leave; });
    planned.warmup_frames =
        int(std::ranges::count_if(planned.frames, [&](int frame) { return warms_up(index_of(frame)); }));
    const bool from_begin = !planned.frames.empty() && planned.frames.front() == run_.frames.front();
    if (!from_begin) planned.history_in.clear();
    return planned;
}

void ResumableRun::begin() {
    journal_.begin(setup_);
}

void ResumableRun::save_checkpoint(std::size_t index, PipelineRenderer& renderer) {
    last_rendered_ = index;
    if (!pipeline_.has_history() || options_.checkpoint_frames <= 0 || warms_up(index)) return;
    if (++since_checkpoint_ < options_.checkpoint_frames) return;
    since_checkpoint_ = 0;
    const fs::path file = checkpoints_.writable(plan_[index].frame);
    try {
        renderer.save_history(file, fingerprints_.of(index).hash);
    } catch (const Error&) {
        // Another worker of this output, which has ended, takes the empty folder away.
        if (std::error_code unreadable; fs::exists(file.parent_path(), unreadable)) throw;
        renderer.save_history(checkpoints_.writable(plan_[index].frame), fingerprints_.of(index).hash);
    }
    checkpoints_.drop_old();
}

RunHooks ResumableRun::hooks() {
    RunHooks hooks;
    hooks.before_frame = [this](int frame, PipelineRenderer& renderer) {
        if (const auto found = histories_.find(index_of(frame)); found != histories_.end())
            renderer.load_history(found->second);
    };
    hooks.is_written = [this](int frame) { return plan_[index_of(frame)].action == FrameAction::write; };
    hooks.fingerprint = [this](int frame) { return fingerprints_.of(index_of(frame)).hash; };
    hooks.after_frame = [this](int frame, PipelineRenderer& renderer) {
        save_checkpoint(index_of(frame), renderer);
    };
    hooks.frame_failed = [this](int frame, PipelineRenderer& renderer) {
        renderer.drop_loaded_history();
        fingerprints_.mark_failed(index_of(frame));
    };
    hooks.frame_written = [this](int frame, const std::vector<fs::path>& files, double seconds) {
        journal_.add(frame, setup_hash_, fingerprints_.of(index_of(frame)), files, seconds);
    };
    hooks.last_fingerprint = [this] {
        return last_rendered_ ? fingerprints_.of(*last_rendered_).hash : std::string();
    };
    return hooks;
}

}  // namespace aftershade
