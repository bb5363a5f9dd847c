#include "cli/resume.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <list>

#include "cli/command_line.h"
#include "framework/base/text.h"
#include "framework/run/run_lock.h"

namespace aftershade::cli {

namespace {

std::string summary_of(const ResumableRun& run) {
    const int writes = run.count(FrameAction::write), renders = run.count(FrameAction::render);
    std::string text =
        fmt::format("{}: {} current, {} to render", counted(std::size_t(run.frame_count()), "frame"),
                    run.frame_count() - writes, writes);
    if (renders > 0)
        text += fmt::format("; {} of the current ones rendered again, but not written, for {}", renders,
                            "the frames after them");
    return text;
}

void print_plan(const ResumableRun& run) {
    for (const PlannedFrame& planned : run.plan())
        if (planned.action == FrameAction::write) fmt::print("frame {}: {}\n", planned.frame, planned.reason);
    fmt::print("{}\n", summary_of(run));
    std::fflush(stdout);
}

ResumeOptions options_of(const ResumeArguments& arguments, const ResumeNeeds& needs, std::size_t frames) {
    ResumeOptions options;
    if (!needs.everything.empty()) options.overwrite = needs.everything + " renders every frame";
    else if (!arguments.keeps_journal(frames))
        options.overwrite = "a run of one frame renders it, unless --resume is given";
    options.checkpoint_frames = arguments.checkpoint_frames;
    options.needs_last = needs.last_frame;
    return options;
}

}  // namespace

void add_resume_options(CLI::App& app, ResumeArguments& arguments) {
    const std::string group =
        "Resuming (a run of several frames skips those that its journal lists as current)";
    auto* const resume =
        app.add_flag("--resume", arguments.resume, "Skip a current frame even if the run has only one")
            ->group(group);
    app.add_flag("--overwrite", arguments.overwrite, "Render every frame, current or not")->group(group);
    app.add_flag("--dry-run", arguments.dry_run, "List the frames to render, with reasons, and run nothing")
        ->group(group);
    app.add_flag("--no-journal", arguments.no_journal,
                 "Render every frame, without journal, lock or checkpoints")
        ->excludes(resume)
        ->group(group);
    app.add_option("--checkpoint", arguments.checkpoint_frames,
                   "Save a look's history every this many frames, so that a killed run can resume; 0: never")
        ->check(CLI::Range(0, 1000000))
        ->capture_default_str()
        ->group(group);
}

ExitCode run_resumable(const ResumeArguments& arguments, const ResumeNeeds& needs,
                       const FingerprintSource& source, const CaptureReader& reader,
                       const std::function<ExitCode(const RunOptions&, const RunHooks&)>& render) {
    const std::vector<int> frames(source.run.frames.begin() + source.run.warmup_frames,
                                  source.run.frames.end());
    std::list<RunLock> locks;
    if (!arguments.dry_run)
        for (const std::string& pattern : source.outputs.patterns) {
            locks.emplace_back(pattern, frames, printed_command(own_arguments()));
            if (!locks.back().is_held() && needs.says)
                fmt::print(stderr,
                           "{}: the file system has no locks: take care that no other run writes "
                           "these frames\n",
                           pattern);
        }
    ResumableRun run(source, reader, options_of(arguments, needs, frames.size()));
    if (arguments.dry_run) {
        print_plan(run);
        return ExitCode::done;
    }
    if (needs.planned) needs.planned(run);
    const int left = run.count(FrameAction::leave);
    if (left + run.count(FrameAction::render) > 0 && needs.says) fmt::print(stderr, "{}\n", summary_of(run));
    ExitCode code = ExitCode::done;
    if (left < int(frames.size())) {
        run.begin();
        code = render(run.planned_run(), run.hooks());
    }
    if (code == ExitCode::done) run.finish();
    return code;
}

}  // namespace aftershade::cli
