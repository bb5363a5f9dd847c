#include "cli/merge_reports.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>

#include "framework/core/atomic_file.h"

namespace aftershade::cli {

namespace {

using Json = nlohmann::ordered_json;

constexpr std::uintmax_t kMostReportBytes = std::uintmax_t(1) << 30;

/// Throws Json::exception where something is missing or of another type.
void add_frames(const Json& report, std::map<int, FrameEvent>& frames) {
    for (const Json& entry : report.at("frames")) {
        FrameEvent event;
        event.frame = entry.at("frame").get<int>();
        event.outcome = entry.at("outcome").get<std::string>();
        event.seconds = entry.value("seconds", 0.0);
        event.message = entry.value("message", "");
        frames[event.frame] = std::move(event);
    }
}

/// What keeps the file from being a report; "" where nothing does, and its content has been added.
std::string add_report(const std::filesystem::path& file, BatchSummary& batch,
                       std::map<int, FrameEvent>& frames) {
    std::string fault;
    const std::string text = read_regular_file(file, kMostReportBytes, fault);
    if (!fault.empty()) return fault;
    try {
        const Json report = Json::parse(text);
        if (report.at("aftershade_report").get<int>() != 1) return "is a report of another version";
        std::map<int, FrameEvent> added;
        add_frames(report, added);
        batch.look = report.value("look", batch.look);
        batch.capture = report.value("capture", batch.capture);
        batch.seconds += report.at("seconds").get<double>();
        for (auto& [frame, event] : added) frames[frame] = std::move(event);
    } catch (const Json::exception&) {
        return "is not a report of run --report";
    }
    return "";
}

}  // namespace

MergedReport merge_reports(const std::vector<std::filesystem::path>& files) {
    MergedReport merged;
    merged.tasks = int(files.size());
    std::map<int, FrameEvent> frames;
    for (const std::filesystem::path& file : files)
        if (const std::string why = add_report(file, merged.batch, frames); !why.empty())
            merged.missing.push_back({file.string(), why});
    for (auto& [frame, event] : frames) merged.batch.frames.push_back(std::move(event));
    const bool whole = merged.missing.empty() && count_outcome(merged.batch.frames, "failed") == 0 &&
                       count_outcome(merged.batch.frames, "not run") == 0;
    merged.batch.exit_code = whole ? ExitCode::done : ExitCode::partial;
    return merged;
}

std::string merged_report_json(const MergedReport& report) {
    Json json = Json::parse(report_json(report.batch));
    json["tasks"] = report.tasks;
    json["missing_reports"] = Json::array();
    for (const MissingReport& missing : report.missing)
        json["missing_reports"].push_back({{"file", missing.file}, {"why", missing.why}});
    return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string merge_summary(const MergedReport& report) {
    std::string text = fmt::format("{} of {} frames done", count_outcome(report.batch.frames, "done"),
                                   report.batch.frames.size());
    for (const char* outcome : {"current", "failed", "skipped", "not run"})
        if (const int count = count_outcome(report.batch.frames, outcome))
            text += fmt::format(", {} {}", count, outcome);
    return text + fmt::format("; {} of {} tasks reported\n", report.tasks - int(report.missing.size()),
                              report.tasks);
}

}  // namespace aftershade::cli
