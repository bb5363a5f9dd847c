#include "cli/run_continuation.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <iostream>
#include <nlohmann/json.hpp>

#include "cli/command_line.h"
#include "framework/base/diagnostics.h"
#include "framework/base/error.h"
#include "framework/base/text.h"

namespace aftershade::cli {

namespace {

std::string interruption_text(const RunArguments& run, const Interruption& end) {
    const std::string count = counted(std::size_t(end.frames), "frame");
    std::string text = "interrupted after " + std::to_string(end.done) + " of " + count;
    if (end.is_complete) return text + "; nothing is left to do";
    if (end.done == end.frames) text += ", before --history-out or --graph was written";
    text += "; to resume";
    if (const std::string option = run.needs_every_frame(); !option.empty())
        text += ", with every frame rendered again (" + option + ")";
    else if (end.has_history)
        text += std::string(", from the ") +
                (run.resume.checkpoint_frames > 0 ? "last checkpoint or the " : "") +
                "beginning of the shot, since history cannot start later (frames that are done are rendered "
                "again, but not written)";
    return text + ":";
}

/// In another shell the variables that number a farm's tasks are not there.
std::string resume_command(const std::string& chunk) {
    std::vector<OptionValue> options;
    Diagnostics faults;
    if (const auto part = parse_chunk(
            chunk, [](const char* name) { return std::getenv(name); }, faults))
        options.push_back({"--chunk", std::to_string(part->index + 1) + "/" + std::to_string(part->count)});
    return command_to_repeat(options);
}

}  // namespace

void print_interruption(ProgressStyle style, const RunArguments& run, const Interruption& end) {
    const std::string text = interruption_text(run, end);
    const std::string command = end.is_complete ? "" : resume_command(run.jobs.chunk);
    const nlohmann::ordered_json event = {{"event", "interrupted"}, {"message", text}, {"command", command}};
    std::cerr << (style == ProgressStyle::json ? event.dump()
                  : command.empty()            ? text
                                               : text + "\n  " + command)
              << "\n";
}

std::string lost_history_text(const Pipeline& pipeline, const Sequence& sequence, const CaptureReader& reader,
                              int first, const std::string& remedy) {
    const bool begins_shot = std::ranges::find(sequence.cuts, first) != sequence.cuts.end();
    if (begins_shot || !sequence.files.has_frame() || !reader.has_frame(sequence.file_number(first - 1)))
        return "";
    std::vector<std::string> steps;
    for (const PipelineStep& step : pipeline.steps)
        if (step.manifest->has_history()) steps.push_back(step.name);
    return fmt::format(
        "frame {}: the history of {} restarts here, although frame {} is there; this frame and "
        "those after it differ from those of an uncut run ({})",
        first, list_of_names(steps, "and"), first - 1, remedy);
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
