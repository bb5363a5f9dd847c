#include <algorithm>
#include <filesystem>
#include <iostream>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "cli/batch_report.h"
#include "cli/verbs.h"
#include "framework/base/atomic_file.h"
#include "framework/base/side_file.h"
#include "framework/base/text.h"
#include "framework/batch/farm_files.h"
#include "framework/capture/frame_range.h"

namespace aftershade::cli {

namespace {

namespace fs = std::filesystem;

// The reports of a farm's tasks as one.

struct TaskReport {
    std::filesystem::path folder;  ///< that the user named, with the reports of a run's tasks; "" for none
    std::filesystem::path name;    ///< in it; without one as the user named it
    std::filesystem::path path() const { return folder / name; }
};

struct MissingReport {
    std::string file;
    std::string why;  ///< as a message ends
};

struct MergedReport {
    BatchSummary batch;  ///< frames in order; seconds are the sum over the tasks
    int tasks = 0;
    std::vector<MissingReport> missing;  ///< also those that are not reports
    std::vector<MissingReport> failed;   ///< whose run ended with an error that no frame has
};

using Json = nlohmann::ordered_json;

constexpr std::uintmax_t kMostReportBytes = std::uintmax_t(1) << 30;

/// A frame's number that is none.
struct UnlikelyFrame {
    std::string text;
};

/// Throws Json::exception where something is missing or of another type.
void add_frames(const Json& report, std::map<int, FrameEvent>& frames) {
    for (const Json& entry : report.at("frames")) {
        FrameEvent event;
        const Json& number = entry.at("frame");
        constexpr int kMost = 999'999'999;  // as in a file's name
        if (!number.is_number_integer() || number < -kMost || number > kMost)
            throw UnlikelyFrame{number.dump()};
        event.frame = number.get<int>();
        event.outcome = entry.at("outcome").get<std::string>();
        event.seconds = entry.value("seconds", 0.0);
        event.message = entry.value("message", "");
        frames[event.frame] = std::move(event);
    }
}

/// Why the run ended, beyond what its frames say: they have what failed, could not be read or was not run.
std::string end_of_run(const Json& report) {
    const int code = report.value("exit_code", 0);
    const std::string error = report.value("error", "");
    const auto is = [&](ExitCode of_frames) { return code == int(of_frames); };
    const bool frames_say =
        is(ExitCode::done) || is(ExitCode::partial) || is(ExitCode::capture) || is(ExitCode::interrupted);
    if (error.empty() && frames_say) return "";
    return fmt::format("its run ended with exit code {}{}{}", code, error.empty() ? "" : ": ", error);
}

/// What keeps the file from being a report; "" where nothing does, and its content has been added.
std::string add_report(const TaskReport& file, BatchSummary& batch, std::map<int, FrameEvent>& frames,
                       std::map<int, TaskReport>& owners, std::string& end) {
    std::string fault;
    const std::string text = file.folder.empty()
                                 ? read_regular_file(file.name, kMostReportBytes, fault)
                                 : read_file_below(file.folder, file.name, kMostReportBytes, fault);
    if (!fault.empty()) return fault;
    try {
        const Json report = Json::parse(text);
        if (report.at("aftershade_report").get<int>() != 1) return "is a report of another version";
        std::map<int, FrameEvent> added;
        add_frames(report, added);
        std::vector<int> twice;
        for (const auto& [frame, event] : added)
            if (const auto owner = owners.find(frame);
                owner != owners.end() && !file.folder.empty() && owner->second.folder == file.folder)
                twice.push_back(frame);
        if (!twice.empty())
            return "has the frames " + format_frame_range(twice) + " of " +
                   owners.at(twice.front()).path().string() +
                   ", too (remove the one that is not of this run)";
        for (const auto& [frame, event] : added) owners[frame] = file;
        batch.look = report.value("look", batch.look);
        batch.capture = report.value("capture", batch.capture);
        if (batch.gl.hardware_fault.empty())
            batch.gl = {report.value("renderer", batch.gl.renderer), "", report.value("hardware_fault", "")};
        batch.seconds += report.at("seconds").get<double>();
        end = end_of_run(report);
        for (auto& [frame, event] : added) frames[frame] = std::move(event);
    } catch (const UnlikelyFrame& frame) {
        return "has a frame " + frame.text + ", which is not a whole number of at most 9 digits";
    } catch (const Json::exception&) {
        return "is not a report of run --report";
    }
    return "";
}

/// A frame that several reports name is as the last of them has it; tasks divide their frames, so of one
/// folder the second report that names a frame does not count. The exit code is `partial` where a frame
/// failed or was not run, a report is missing, or a run ended with an error and no later report has its
/// frames.
MergedReport merge_reports(const std::vector<TaskReport>& files) {
    MergedReport merged;
    merged.tasks = int(files.size());
    std::map<int, FrameEvent> frames;
    std::map<int, TaskReport> owners;
    struct Ended {
        TaskReport file;
        std::string why;
        bool has_frames;
    };
    std::vector<Ended> ended;
    const auto owns_some = [&](const TaskReport& file) {
        return std::ranges::any_of(owners,
                                   [&](const auto& owner) { return owner.second.path() == file.path(); });
    };
    for (const TaskReport& file : files) {
        std::string end;
        if (const std::string why = add_report(file, merged.batch, frames, owners, end); !why.empty())
            merged.missing.push_back({file.path().string(), why});
        else if (!end.empty()) ended.push_back({file, end, owns_some(file)});
    }
    for (auto& [frame, event] : frames) merged.batch.frames.push_back(std::move(event));
    for (const Ended& one : ended)
        if (!one.has_frames || owns_some(one.file))
            merged.failed.push_back({one.file.path().string(), one.why});
    if (!merged.failed.empty())
        merged.batch.error = merged.failed.front().file + ": " + merged.failed.front().why;
    const bool whole = merged.missing.empty() && merged.failed.empty() &&
                       count_outcome(merged.batch.frames, "failed") == 0 &&
                       count_outcome(merged.batch.frames, "not run") == 0;
    merged.batch.exit_code = whole ? ExitCode::done : ExitCode::partial;
    return merged;
}

/// A report of `run --report` with "tasks" and "missing_reports" besides.
std::string merged_report_json(const MergedReport& report) {
    Json json = Json::parse(report_json(report.batch));
    json["tasks"] = report.tasks;
    json["missing_reports"] = Json::array();
    for (const MissingReport& missing : report.missing)
        json["missing_reports"].push_back({{"file", missing.file}, {"why", missing.why}});
    return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

/// "46 of 48 frames done, 2 failed; 12 of 12 tasks reported\n"
std::string merge_summary(const MergedReport& report) {
    std::string text = fmt::format("{} of {} frames done", count_outcome(report.batch.frames, "done"),
                                   report.batch.frames.size());
    for (const char* outcome : {"current", "failed", "skipped", "not run"})
        if (const int count = count_outcome(report.batch.frames, outcome))
            text += fmt::format(", {} {}", count, outcome);
    return text + fmt::format("; {} of {} tasks reported\n", report.tasks - int(report.missing.size()),
                              report.tasks);
}

struct MergeArguments {
    std::vector<std::string> reports;
    std::string output;
    int tasks = 0;  ///< 0: as many as there are reports
};

bool is_same(const fs::path& a, const fs::path& b) {
    std::error_code absent;
    return fs::equivalent(a, b, absent);
}

/// The files meant: each as it is named; of a folder, those of its tasks.
std::vector<TaskReport> report_files(const MergeArguments& options) {
    std::vector<TaskReport> files;
    for (const std::string& name : options.reports) {
        if (!fs::is_directory(name)) {
            files.push_back({"", name});
        } else if (options.tasks > 0) {
            for (int task = 1; task <= options.tasks; ++task)
                files.push_back({name, task_name(task) + ".json"});
        } else {
            std::set<fs::path> sorted;
            for (const auto& entry : fs::directory_iterator(name))
                if (entry.path().extension() == ".json" && !is_same(entry.path(), options.output))
                    sorted.insert(entry.path().filename());
            for (const fs::path& file : sorted) files.push_back({name, file});
        }
    }
    return files;
}

ExitCode merge(const MergeArguments& options) {
    const std::vector<TaskReport> files = report_files(options);
    if (files.empty()) throw Error(ErrorKind::capture, options.reports.front() + ": holds no report (.json)");
    const MergedReport merged = merge_reports(files);
    write_text_file(options.output, merged_report_json(merged));
    for (const auto* faults : {&merged.missing, &merged.failed})
        for (const MissingReport& report : *faults)
            std::cerr << printable(report.file + ": " + report.why) << "\n";
    std::cerr << failures_text(merged.batch.frames) << merge_summary(merged);
    return merged.batch.exit_code;
}

}  // namespace

Verb add_merge(CLI::App& app) {
    auto options = std::make_shared<MergeArguments>();
    app.add_option("reports", options->reports,
                   "Reports of run --report, or a folder of them; for a frame in several, the last counts")
        ->required();
    app.add_option("-o,--output", options->output, "Write the merged report to this .json")->required();
    app.add_option("--tasks", options->tasks,
                   "Number of reports to expect in the folder: 0001.json, 0002.json, ...")
        ->check(CLI::PositiveNumber);
    return [options] { return merge(*options); };
}

}  // namespace aftershade::cli
