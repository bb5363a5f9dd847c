#include "cli/batch_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>

#include "framework/base/text.h"
#include "framework/capture/frame_range.h"

namespace aftershade::cli {

int count_outcome(const std::vector<FrameEvent>& frames, const std::string& outcome) {
    return int(std::count_if(frames.begin(), frames.end(),
                             [&](const FrameEvent& event) { return event.outcome == outcome; }));
}

FrameEvent frame_event(const FrameOutcome& outcome) {
    const char* name = outcome.kind == FrameOutcome::Kind::done     ? "done"
                       : outcome.kind == FrameOutcome::Kind::failed ? "failed"
                                                                    : "skipped";
    return {outcome.frame, name, outcome.seconds, outcome.message};
}

std::vector<FrameEvent> frame_events(const RunOptions& run, const std::vector<FrameOutcome>& outcomes,
                                     const std::vector<int>& current) {
    std::map<int, FrameEvent> by_frame;
    for (std::size_t i = std::size_t(run.warmup_frames); i < run.frames.size(); ++i)
        by_frame[run.frames[i]] = {run.frames[i], "not run", 0, ""};
    for (const int frame : current) by_frame[frame] = {frame, "current", 0, ""};
    for (const FrameOutcome& outcome : outcomes) by_frame[outcome.frame] = frame_event(outcome);
    std::vector<FrameEvent> events;
    for (const auto& [frame, event] : by_frame) events.push_back(event);
    return events;
}

namespace {

std::string cause_of_not_run(const BatchSummary& summary) {
    if (!summary.error.empty()) return "the run ended: " + summary.error;
    if (summary.exit_code == ExitCode::interrupted) return "the run was interrupted";
    return "the run ended at a frame that failed";
}

}  // namespace

std::string report_json(const BatchSummary& summary) {
    nlohmann::ordered_json frames = nlohmann::ordered_json::array();
    for (const FrameEvent& event : summary.frames) {
        nlohmann::ordered_json entry = {{"frame", event.frame}, {"outcome", event.outcome}};
        if (event.outcome == "done") entry["seconds"] = event.seconds;
        if (!event.message.empty()) entry["message"] = event.message;
        else if (event.outcome == "not run") entry["message"] = cause_of_not_run(summary);
        frames.push_back(std::move(entry));
    }
    nlohmann::ordered_json report = {{"aftershade_report", 1},
                                     {"look", summary.look},
                                     {"capture", summary.capture},
                                     {"exit_code", int(summary.exit_code)},
                                     {"seconds", summary.seconds},
                                     {"done", count_outcome(summary.frames, "done")},
                                     {"current", count_outcome(summary.frames, "current")},
                                     {"failed", count_outcome(summary.frames, "failed")},
                                     {"skipped", count_outcome(summary.frames, "skipped")},
                                     {"not_run", count_outcome(summary.frames, "not run")},
                                     {"frames", std::move(frames)}};
    if (const DrawnBy& gl = summary.gl; !gl.renderer.empty()) {
        report["renderer"] = gl.renderer;
        if (!gl.device.empty()) report["device"] = gl.device;
        report["hardware_not_usable"] = !gl.hardware_fault.empty();
        if (!gl.hardware_fault.empty()) report["hardware_fault"] = gl.hardware_fault;
    }
    if (!summary.error.empty()) report["error"] = summary.error;
    return report.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
}

std::string failures_text(const std::vector<FrameEvent>& frames) {
    const int failed = count_outcome(frames, "failed");
    if (failed == 0) return "";
    std::string text = fmt::format("{} of {} failed:\n", failed, counted(frames.size(), "frame"));
    for (const FrameEvent& event : frames)
        if (event.outcome == "failed")
            text += fmt::format("  frame {}: {}\n", event.frame, printable(event.message));
    return text;
}

}  // namespace aftershade::cli
