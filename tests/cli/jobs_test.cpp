// Worker processes and chunks of `run`.
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <regex>

#include "tests/cli/batch_work.h"

namespace aftershade::test {
namespace {

namespace fs = std::filesystem;

class Jobs : public BatchWork {
protected:
    Jobs() {
        write_frames(1, 8);
        fs::create_directories(folder_ / "one");
        fs::create_directories(folder_ / "many");
    }
    void truncate(int frame) { fs::resize_file(frame_path(frame), fs::file_size(frame_path(frame)) / 2); }
    std::string bytes(const std::string& folder, int frame) const {
        return read_text(folder_ / folder / FramePattern("f_####.exr").path(frame));
    }
    void expect_same_frames(int first, int last) const {
        for (int frame = first; frame <= last; ++frame)
            EXPECT_EQ(bytes("many", frame), bytes("one", frame)) << frame;
    }
    /// The report has the message of what ended the run, and so has each frame that was not run.
    void expect_cause(const std::string& part) const {
        const nlohmann::json made = report();
        const std::string error = made.value("error", "");
        EXPECT_NE(error.find(part), std::string::npos) << made.dump(2);
        for (const auto& frame : made["frames"])
            if (frame["outcome"] == "not run") {
                EXPECT_EQ(frame.value("message", ""), "the run ended: " + error) << frame;
            }
    }
    nlohmann::json report(const std::string& name = "report.json") const {
        return nlohmann::json::parse(read_text(folder_ / name));
    }
};

TEST_F(Jobs, WriteTheBytesOfOneProcess) {
    run({"spread.json", "in_####.exr", "-o", "one/f_####.exr"}, 0);
    const CommandResult result =
        run({"spread.json", "in_####.exr", "-o", "many/f_####.exr", "--jobs", "3"}, 0);
    expect_same_frames(1, 8);
    EXPECT_EQ(lines_of_text(result.out).size(), 8u) << "each file is named once on stdout";
    EXPECT_NE(result.err.find("8 of 8 frames"), std::string::npos) << result.err;
}

TEST_F(Jobs, LeaveOutFramesThatAreCurrent) {
    run({"spread.json", "in_####.exr", "-o", "many/f_####.exr", "--jobs", "2"}, 0);
    fs::remove(folder_ / "many/f_0005.exr");
    const CommandResult again =
        run({"spread.json", "in_####.exr", "-o", "many/f_####.exr", "--jobs", "2"}, 0);
    EXPECT_EQ(lines_of_text(again.out), std::vector<std::string>{"many/f_0005.exr"});
    EXPECT_NE(again.err.find("7 frames were current"), std::string::npos) << again.err;
}

TEST_F(Jobs, ABrokenInputCostsItsFrameAndTheReportSaysWhy) {
    truncate(4);
    const CommandResult result = run({"spread.json", "in_####.exr", "-o", "many/f_####.exr", "--jobs", "2",
                                      "--report", "reports/new/report.json"},
                                     1);
    const nlohmann::json made = report("reports/new/report.json");
    EXPECT_EQ(made["done"], 7);
    EXPECT_EQ(made["failed"], 1);
    EXPECT_EQ(made["exit_code"], 1);
    EXPECT_EQ(made["frames"][3]["outcome"], "failed");
    EXPECT_NE(made["frames"][3]["message"].get<std::string>().find("in_0004.exr"), std::string::npos);
    EXPECT_NE(result.err.find("1 of 8 frames failed:\n  frame 4: "), std::string::npos) << result.err;
}

TEST_F(Jobs, ARunInOneProcessWritesTheSameReport) {
    truncate(4);
    run({"spread.json", "in_####.exr", "-o", "many/f_####.exr", "--report", "report.json"}, 1);
    EXPECT_EQ(report()["done"], 7);
    EXPECT_EQ(report()["frames"][3]["outcome"], "failed");
}

TEST_F(Jobs, AReportCountsFramesOfEarlierRunsAsCurrent) {
    const std::vector<std::string> words{"spread.json",     "in_####.exr", "-o",
                                         "many/f_####.exr", "--report",    "report.json"};
    run(words, 0);
    run(words, 0);
    EXPECT_EQ(report()["current"], 8);
    fs::remove(folder_ / "many/f_0005.exr");
    run(words, 0);
    EXPECT_EQ(report()["current"], 7);
    EXPECT_EQ(report()["done"], 1);
    EXPECT_EQ(report()["not_run"], 0);
}

TEST_F(Jobs, StopAtTheFirstErrorWhereAsked) {
    write_frames(1, 40, 480, 270);
    truncate(2);
    run({"spread.json", "in_####.exr", "-o", "many/f_####.exr", "--jobs", "1", "--stop-on-error", "--report",
         "report.json"},
        1);
    EXPECT_GT(report()["not_run"].get<int>(), 0);
    EXPECT_EQ(report()["frames"][1]["outcome"], "failed");
    run({"spread.json", "in_####.exr", "-o", "one/f_####.exr", "--stop-on-error", "--report", "report.json"},
        1);
    EXPECT_EQ(report()["not_run"], 38) << "in one process no frame behind the second is begun";
    EXPECT_EQ(report()["frames"][2]["message"], "the run ended at a frame that failed");
}

TEST_F(Jobs, AReportOfAnErrorHasItsExitCode) {
    fs::create_directories(folder_ / "taken/f_0003.exr");
    run({"spread.json", "in_####.exr", "-o", "taken/f_####.exr", "--report", "report.json"}, 6);
    EXPECT_EQ(report()["exit_code"], 6);
    EXPECT_GT(report()["not_run"].get<int>(), 0);
    expect_cause("f_0003.exr");
}

TEST_F(Jobs, AReportOfWorkersHasTheErrorThatEndedThemAll) {
    fs::create_directories(folder_ / "taken/f_0003.exr");
    run({"spread.json", "in_####.exr", "-o", "taken/f_####.exr", "--jobs", "2", "--report", "report.json"},
        6);
    EXPECT_EQ(report()["exit_code"], 6);
    expect_cause("f_0003.exr");
}

TEST_F(Jobs, WithHistoryNeedADeclaredOrAGivenWarmup) {
    const CommandResult refused =
        run({"trail.json", "in_####.exr", "-o", "many/f_####.exr", "--jobs", "2"}, 2);
    EXPECT_NE(refused.err.find("step 'trail' has history and its effect declares no warm-up"),
              std::string::npos)
        << refused.err;
    run({"trail.json", "in_####.exr", "-o", "one/f_####.exr"}, 0);
    run({"trail.json", "in_####.exr", "-o", "many/f_####.exr", "--jobs", "2", "--warmup", "2"}, 0);
    expect_same_frames(1, 4);
    // Each frame of warm-up halves what the trail lacks: 1/8 of the difference of two frames is left in
    // frame 5.
    const Image uncut = color("one/f_0005.exr"), cut = color("many/f_0005.exr");
    float largest = 0;
    for (std::size_t i = 0; i < uncut.floats().size(); ++i)
        largest = std::max(largest, std::abs(uncut.floats()[i] - cut.floats()[i]));
    EXPECT_GT(largest, 0);
    EXPECT_LT(largest, 0.25f);
}

TEST_F(Jobs, AChunkIsItsPartOfTheFrames) {
    run({"spread.json", "in_####.exr", "-o", "one/f_####.exr"}, 0);
    for (const char* chunk : {"1/3", "2/3", "3/3"})
        run({"spread.json", "in_####.exr", "-o", "many/f_####.exr", "--chunk", chunk}, 0);
    expect_same_frames(1, 8);
    const CommandResult none =
        run({"spread.json", "in_####.exr", "-o", "many/f_####.exr", "--frames", "1-2", "--chunk", "1/3"}, 0);
    EXPECT_NE(none.err.find("no frames"), std::string::npos) << none.err;
}

TEST_F(Jobs, ChunksWithSavedHistoryAreTheUncutRun) {
    run({"trail.json", "in_####.exr", "-o", "one/f_####.exr"}, 0);
    run({"trail.json", "in_####.exr", "-o", "many/f_####.exr", "--chunk", "1/2", "--warmup", "0",
         "--history-out", "half"},
        0);
    run({"trail.json", "in_####.exr", "-o", "many/f_####.exr", "--chunk", "2/2", "--history-in", "half"}, 0);
    for (int frame = 1; frame <= 8; ++frame)
        EXPECT_EQ(color("many/" + FramePattern("f_####.exr").path(frame)).floats()[100],
                  color("one/" + FramePattern("f_####.exr").path(frame)).floats()[100]);
}

TEST_F(Jobs, AFarmsVariablesNumberTheChunk) {
    const auto written = [&](const std::string& chunk, const Environment& environment) {
        const auto lines = lines_of_text(
            run({"nothing.json", "in_####.exr", "-o", "many/f_####.exr", "--overwrite", "--chunk", chunk}, 0,
                environment)
                .out);
        return lines.empty() ? std::string() : lines.front() + " " + std::to_string(lines.size());
    };
    EXPECT_EQ(written("auto", {{"SLURM_ARRAY_TASK_ID", "7"},
                               {"SLURM_ARRAY_TASK_MIN", "5"},
                               {"SLURM_ARRAY_TASK_COUNT", "4"},
                               {"SLURM_ARRAY_TASK_STEP", "1"}}),
              "many/f_0005.exr 2");
    EXPECT_EQ(written("auto/4", {{"JOB_COMPLETION_INDEX", "3"}}), "many/f_0007.exr 2");
    EXPECT_EQ(written("auto", {{"AWS_BATCH_JOB_ARRAY_INDEX", "0"}, {"AWS_BATCH_JOB_ARRAY_SIZE", "2"}}),
              "many/f_0001.exr 4");
    const CommandResult unset =
        run({"nothing.json", "in_####.exr", "-o", "many/f_####.exr", "--chunk", "auto"}, 2);
    EXPECT_NE(unset.err.find("no variable of Slurm"), std::string::npos) << unset.err;
}

TEST_F(Jobs, RefuseWhatNeedsOneProcess) {
    const CommandResult result = run({"spread.json", "in_####.exr", "-o", "many/f_####.exr", "--jobs", "2",
                                      "--graph", "g.dot", "--history-out", "h", "--trace", "t.json"},
                                     2);
    for (const char* option : {"--graph", "--history-out", "--trace"})
        EXPECT_NE(result.err.find(std::string(option) + ": "), std::string::npos) << result.err;
    run({"spread.json", "in_####.exr", "-o", "many/f_####.exr", "--jobs", "0"}, 2);
    run({"spread.json", "in_####.exr", "-o", "many/f_####.exr", "--chunk", "4/3"}, 2);
    run({"spread.json", "in_####.exr", "-o", "many/f_####.exr", "--warmup", "-1"}, 2);
}

TEST_F(Jobs, AnOutputThatCannotBeWrittenEndsTheRun) {
    fs::create_directories(folder_ / "taken/f_0003.exr");  // a folder where a file should go
    const CommandResult result =
        run({"spread.json", "in_####.exr", "-o", "taken/f_####.exr", "--jobs", "2"}, 6);
    EXPECT_NE(result.err.find("f_0003.exr"), std::string::npos) << result.err;
}

TEST_F(Jobs, AnInterruptPrintsTheCommandThatGoesOn) {
    write_frames(1, 80, 320, 180);
    Command command({AFTERSHADE_EXECUTABLE, "run", "spread.json", "in_####.exr", "-o", "many/f_####.exr",
                     "--effect-path", "effects", "--backend", "software", "--jobs", "2"},
                    folder_.path());
    while (!fs::exists(folder_ / "many/f_0003.exr"))
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
    command.send(SIGINT);
    const CommandResult result = command.wait();
    EXPECT_EQ(result.exit_code, 130) << result.err;
    EXPECT_TRUE(std::regex_search(result.err, std::regex("interrupted after [0-9]+ of 80 frames; to resume:\n"
                                                         "  cd [^\n]* --jobs 2\n$")))
        << result.err;
    EXPECT_EQ(result.err.find("/proc/self"), std::string::npos) << "of a worker: " << result.err;
    EXPECT_EQ(temporaries(), std::vector<std::string>{});
}

}  // namespace
}  // namespace aftershade::test
