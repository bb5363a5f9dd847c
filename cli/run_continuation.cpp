#include "cli/run_continuation.h"

#include <algorithm>

#include "cli/command_line.h"
#include "framework/capture/frame_range.h"
#include "framework/core/diagnostics.h"
#include "framework/core/error.h"
#include "framework/core/text.h"

namespace aftershade::cli {

std::string continuation_text(const std::vector<std::string>& command, const RunOptions& run,
                              const RunReport& report) {
    if (report.frames_left.empty()) return "";
    std::vector<int> frames = report.frames_left;
    std::vector<OptionValue> options{{"--frames", ""}};
    std::string why;
    if (report.history_saved) options.push_back({"--history-in", run.history_out.string()});
    const bool begun = frames.size() < run.frames.size();
    if (begun && !report.history_saved && (report.history_begin || !run.history_in.empty())) {
        auto from = run.frames.begin();
        if (report.history_begin) {
            from = std::ranges::find(run.frames, *report.history_begin);
            options.push_back({"--history-in", ""});  // of before this shot
        }
        frames.assign(from, run.frames.end());
        why = " from where the history began, which was not kept (--history-out keeps it)";
    }
    options.front().value = format_frame_range(frames);
    return "interrupted after " + std::to_string(report.frames_done) + " of " +
           std::to_string(run.frames.size()) + " frames; to resume" + why + ":\n  " +
           shell_line(with_options(command, options)) + "\n";
}

std::string lost_history_text(const Pipeline& pipeline, const Sequence& sequence, const CaptureReader& reader,
                              const RunOptions& run) {
    if (!pipeline.has_history() || !run.history_in.empty() || run.frames.empty()) return "";
    const int first = run.frames.front();
    const bool begins_shot = std::ranges::find(sequence.cuts, first) != sequence.cuts.end();
    if (begins_shot || !sequence.files.has_frame() || !reader.has_frame(sequence.file_number(first - 1)))
        return "";
    std::vector<std::string> steps;
    for (const PipelineStep& step : pipeline.steps)
        if (step.manifest->has_history()) steps.push_back(step.name);
    const std::string number = std::to_string(first);
    return "frame " + number + ": the history of " + list_of_names(steps, "and") +
           " restarts here, although frame " + std::to_string(first - 1) +
           " is there; this frame and those after it differ from those of an uncut run (run the frames up "
           "to " +
           std::to_string(first - 1) + " with --history-out FILE, and these with --history-in FILE)";
}

std::vector<std::string> stale_layers_texts(const Pipeline& pipeline, const Sequence& sequence,
                                            const CaptureReader& reader) {
    const std::vector<StaleLayers> stale = find_stale_layers(pipeline);
    if (stale.empty() || sequence.frames.empty()) return {};
    try {
        if (reader.read_header(sequence.file_number(sequence.frames.front())).layer_roles.empty()) return {};
    } catch (const Error&) {
        return {};  // the run reports it
    }
    std::vector<std::string> texts;
    for (const StaleLayers& one : stale)
        texts.push_back("step '" + one.step + "' reads the capture's layers, and " +
                        list_of_names(one.changed_by, "and") +
                        " before it changed the picture's color alone; move what changes light behind '" +
                        one.step + "'");
    return texts;
}

}  // namespace aftershade::cli
