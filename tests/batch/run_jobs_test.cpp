// Workers as shell scripts: what a batch does with their crashes, hangs and errors.
#include "framework/batch/run_jobs.h"
#include "framework/batch/process_codes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <numeric>

#include "framework/base/text.h"
#include "tests/temporary_folder.h"

namespace aftershade {
namespace {

using Outcomes = std::map<int, std::string>;

/// `for_frame` is what a worker does for the frame $f, after it has said that it begins it; done() says that
/// the frame is done.
JobOptions jobs_of_script(const std::string& for_frame, std::vector<JobPiece> pieces) {
    const std::string script =
        "say() { echo \"$1\" >&$AFTERSHADE_STATUS_FD; }\n"
        "done_() { say "
        "\"{\\\"event\\\":\\\"frame\\\",\\\"frame\\\":$f,\\\"outcome\\\":\\\"done\\\",\\\"seconds\\\":0}\"; "
        "}\n"
        "warmup=$1; shift\n"
        "for f in \"$@\"; do say \"{\\\"frame\\\":$f}\"\n"
        "if [ $warmup -gt 0 ]; then warmup=$((warmup-1)); echo warm $f; continue; fi\n" +
        for_frame + "\ndone\n";
    JobOptions options;
    options.pieces = std::move(pieces);
    options.command = [script](const JobPiece& piece, int) {
        std::vector<std::string> words{"/bin/sh", "-c", script, "worker",
                                       std::to_string(piece.warmup_frames)};
        for (const int frame : piece.frames) words.push_back(std::to_string(frame));
        return words;
    };
    return options;
}

Outcomes outcomes(const JobsReport& report) {
    Outcomes by_frame;
    for (const FrameEvent& event : report.frames) by_frame[event.frame] = event.outcome;
    return by_frame;
}

std::string message_of(const JobsReport& report, int frame) {
    for (const FrameEvent& event : report.frames)
        if (event.frame == frame) return event.message;
    return "";
}

const std::atomic<bool> kGoOn = false;

TEST(FrameEvent, ReadsBackAsItself) {
    const FrameEvent event{12, "failed", 0.5, "a \"quoted\" \n line"};
    EXPECT_EQ(parse_event(event_line(event)), event);
    EXPECT_EQ(parse_event(status_line({"grade", "", "", 12})), std::nullopt);
    EXPECT_LE(event_line({1, "failed", 0, std::string(100'000, '\1')}).size(), 4096u);
}

TEST(RunJobs, GiveEveryFrameToOneWorker) {
    int lines = 0;
    JobListener listener;
    listener.on_stdout = [&](std::string_view) { ++lines; };
    const JobsReport report =
        run_jobs(jobs_of_script("echo file $f; done_", {{{1, 3, 5}}, {{2, 4}}}), listener, kGoOn);
    EXPECT_EQ(report.exit_code, ExitCode::done);
    EXPECT_EQ(lines, 5);
    EXPECT_EQ(outcomes(report), (Outcomes{{1, "done"}, {2, "done"}, {3, "done"}, {4, "done"}, {5, "done"}}));
}

TEST(RunJobs, ACrashCostsTheFrameThatTheWorkerWasAt) {
    const JobsReport report =
        run_jobs(jobs_of_script("[ $f = 3 ] && kill -SEGV $$; done_", {{{1, 2, 3, 4, 5}}}), {}, kGoOn);
    EXPECT_EQ(report.exit_code, ExitCode::partial);
    EXPECT_EQ(outcomes(report),
              (Outcomes{{1, "done"}, {2, "done"}, {3, "failed"}, {4, "done"}, {5, "done"}}));
    EXPECT_EQ(message_of(report, 3), "the worker crashed (signal 11, SIGSEGV) in frame 3");
}

TEST(RunJobs, AFrameWhoseFilesWereNotYetInPlaceIsRenderedAgain) {
    // Frame 2 is reported done only when frame 3 has been rendered; the crash in 3 takes it along.
    const JobsReport report = run_jobs(
        jobs_of_script("[ $f = 3 ] && kill -SEGV $$; [ $f = 2 ] && [ \"$3\" = 2 ] && continue; done_",
                       {{{1, 2, 3, 4}}}),
        {}, kGoOn);
    EXPECT_EQ(outcomes(report), (Outcomes{{1, "done"}, {2, "done"}, {3, "failed"}, {4, "done"}}));
}

TEST(RunJobs, FramesThatAreCurrentCountAsDone) {
    const JobsReport report =
        run_jobs(jobs_of_script("[ $f = 1 ] && for c in 3 4; do say "
                                "\"{\\\"event\\\":\\\"frame\\\",\\\"frame\\\":$c,\\\"outcome\\\":"
                                "\\\"current\\\",\\\"seconds\\\":0}\"; done\n"
                                "case $f in 1|5) done_;; 2) kill -SEGV $$;; esac",
                                {{{1, 2, 3, 4, 5}}}),
                 {}, kGoOn);
    EXPECT_EQ(outcomes(report),
              (Outcomes{{1, "done"}, {2, "failed"}, {3, "current"}, {4, "current"}, {5, "done"}}));
    EXPECT_EQ(report.exit_code, ExitCode::partial);
}

TEST(RunJobs, AHangCostsAFrame) {
    JobOptions options = jobs_of_script("[ $f = 2 ] && sleep 60; done_", {{{1, 2, 3}}});
    options.frame_timeout = std::chrono::milliseconds(500);
    const JobsReport report = run_jobs(options, {}, kGoOn);
    EXPECT_EQ(outcomes(report), (Outcomes{{1, "done"}, {2, "failed"}, {3, "done"}}));
    EXPECT_EQ(message_of(report, 2), "the worker did not finish within 0.5 s and was killed in frame 2");
}

TEST(RunJobs, APassThatTakesTooLongCostsAFrame) {
    const auto at_pass = [](const std::string& foreign) {
        return "[ $f = 2 ] && { say '{\"step\":\"grade\",\"phase\":\"draw\",\"frame\":2,\"effect\":\"tint\","
               "\"pass\":\"main\"" +
               foreign + "}'; sleep 1; }; done_";
    };
    JobOptions options = jobs_of_script(at_pass(",\"foreign\":true"), {{{1, 2, 3}}});
    options.pass_limit.timeout = std::chrono::milliseconds(300);
    const JobsReport report = run_jobs(options, {}, kGoOn);
    EXPECT_EQ(outcomes(report), (Outcomes{{1, "done"}, {2, "failed"}, {3, "done"}}));
    EXPECT_EQ(
        message_of(report, 2),
        "the GL driver did not finish within 0.3 s and was killed while drawing pass 'main' of step 'grade' "
        "(effect 'tint'), frame 2");
    options = jobs_of_script(at_pass(""), {{{1, 2, 3}}});
    options.pass_limit.timeout = std::chrono::milliseconds(300);
    EXPECT_EQ(run_jobs(options, {}, kGoOn).exit_code, ExitCode::done) << "a shipped effect has its time";
    options.pass_limit.of_shipped_effects = true;
    EXPECT_EQ(run_jobs(options, {}, kGoOn).exit_code, ExitCode::partial);
}

TEST(RunJobs, AnErrorOfOneFrameIsItsMessage) {
    const JobsReport report = run_jobs(
        jobs_of_script("[ $f = 2 ] && { echo 'aftershade: error: step blur: too much' >&2; exit 5; }; done_",
                       {{{1, 2, 3}}}),
        {}, kGoOn);
    EXPECT_EQ(outcomes(report), (Outcomes{{1, "done"}, {2, "failed"}, {3, "done"}}));
    EXPECT_EQ(message_of(report, 2), "step blur: too much");
}

TEST(RunJobs, APluginThatEndsTheProcessCostsAFrame) {
    const JobsReport report =
        run_jobs(jobs_of_script("[ $f = 2 ] && exit 0; done_", {{{1, 2, 3}}}), {}, kGoOn);
    EXPECT_EQ(outcomes(report), (Outcomes{{1, "done"}, {2, "failed"}, {3, "done"}}));
    EXPECT_EQ(message_of(report, 2), "the worker ended with code 0 in frame 2");
}

TEST(RunJobs, HistoryIsWarmedUpBehindAFailedFrame) {
    std::string warm;
    JobListener listener;
    listener.on_stdout = [&](std::string_view line) { warm += std::string(line) + ","; };
    JobOptions options = jobs_of_script("[ $f = 5 ] && kill -SEGV $$; done_", {{{1, 2, 3, 4, 5, 6}}});
    options.warmup_frames = 2;
    const JobsReport report = run_jobs(options, listener, kGoOn);
    EXPECT_EQ(outcomes(report).at(6), "done");
    EXPECT_EQ(warm, "warm 3,warm 4,");
}

TEST(RunJobs, AWorkerThatCrashesAfterItsLastFrameMakesNoRunSucceed) {
    std::string said;
    JobListener listener;
    listener.on_stderr = [&](std::string_view line) { said += line; };
    const JobsReport report = run_jobs(
        jobs_of_script("done_; if [ $f = 3 ]; then kill -SEGV $$; fi", {{{1, 2, 3}}}), listener, kGoOn);
    EXPECT_EQ(outcomes(report), (Outcomes{{1, "done"}, {2, "done"}, {3, "done"}}));
    EXPECT_EQ(report.exit_code, ExitCode::effect);
    EXPECT_EQ(said, "aftershade: error: " + report.error);
    EXPECT_NE(said.find("SIGSEGV"), std::string::npos) << said;
}

TEST(RunJobs, AnErrorThatNoFrameEscapesEndsTheRun) {
    const auto fails_with = [](int code) {
        return run_jobs(jobs_of_script("exit " + std::to_string(code), {{{1, 2, 3}}, {{4, 5, 6}}}), {},
                        kGoOn);
    };
    for (const ExitCode code : {ExitCode::usage, ExitCode::gl, ExitCode::output}) {
        const JobsReport report = fails_with(int(code));
        EXPECT_EQ(report.exit_code, code);
        EXPECT_EQ(outcomes(report).at(3), "not run");
    }
}

TEST(RunJobs, ThreeWorkersThatFinishNoFrameGiveUp) {
    const JobsReport report = run_jobs(jobs_of_script("kill -SEGV $$", {{{1, 2, 3, 4, 5, 6}}}), {}, kGoOn);
    EXPECT_EQ(report.exit_code, ExitCode::effect);
    EXPECT_EQ(outcomes(report).at(3), "failed");
    EXPECT_EQ(outcomes(report).at(4), "not run");
}

TEST(RunJobs, StopAtTheFirstErrorWhereAsked) {
    JobOptions options = jobs_of_script(
        "if [ $f = 2 ]; then say "
        "'{\"event\":\"frame\",\"frame\":2,\"outcome\":\"failed\",\"seconds\":0,\"message\":\"no file\"}'; "
        "sleep 5; else done_; fi",
        {{{1, 2, 3}}});
    options.stop_on_error = true;
    const JobsReport report = run_jobs(options, {}, kGoOn);
    EXPECT_EQ(outcomes(report), (Outcomes{{1, "done"}, {2, "failed"}, {3, "not run"}}));
    EXPECT_EQ(message_of(report, 2), "no file");
    EXPECT_EQ(report.exit_code, ExitCode::partial);
}

TEST(RunJobs, AnInterruptEndsAllWorkers) {
    std::atomic<bool> stop = false;
    JobListener listener;
    listener.on_frame = [&](const FrameEvent&) { stop = true; };
    const JobsReport report =
        run_jobs(jobs_of_script("[ $f = 2 ] && sleep 60; done_", {{{1, 2, 3}}, {{4}}}), listener, stop);
    EXPECT_TRUE(report.interrupted);
    EXPECT_EQ(report.exit_code, ExitCode::interrupted);
    EXPECT_EQ(outcomes(report).at(3), "not run");
}

}  // namespace
}  // namespace aftershade
