// Sequences with holes, history begun in the middle, empty words, watching.
#include <chrono>
#include <nlohmann/json.hpp>
#include <regex>
#include <thread>

#include "framework/batch/process_codes.h"
#include "tests/cli/batch_work.h"

namespace aftershade::test {
namespace {

namespace fs = std::filesystem;

class Batch : public BatchWork {
protected:
    static bool says(const CommandResult& result, const std::string& text) {
        return std::regex_search(result.err, std::regex(text));
    }
};

TEST_F(Batch, AMissingFrameOfAPatternIsAnErrorThatNamesIt) {
    write_frames(1, 6);
    for (const int frame : {3, 4}) fs::remove(frame_path(frame));
    const CommandResult result =
        run({"nothing.json", "in_####.exr", "-o", "out_####.exr"}, int(ExitCode::partial));
    EXPECT_EQ(result.out, "out_0001.exr\nout_0002.exr\nout_0005.exr\nout_0006.exr\n");
    EXPECT_TRUE(says(result, "in_####\\.exr: warning: frames 3-4 of 1-6 are missing \\(--missing skip .*"))
        << result.err;
    for (const char* name : {"in_0003", "in_0004"})
        EXPECT_TRUE(says(result, "aftershade: error: " + std::string(name) + "\\.exr: ")) << result.err;
}

TEST_F(Batch, AReportThatCannotBeWrittenIsAnOutputThatCannotBeWritten) {
    write_frames(1, 2);
    const auto full = [&](const std::vector<std::string>& more, ExitCode code) {
        std::vector<std::string> words{"nothing.json", "in_####.exr", "-o",         "out_####.exr",
                                       "--report",     "/dev/full",   "--overwrite"};
        words.insert(words.end(), more.begin(), more.end());
        const CommandResult result = run(words, int(code));
        EXPECT_TRUE(says(result, "/dev/full: .*No space left on device")) << result.err;
    };
    full({}, ExitCode::output);
    full({"--jobs", "2"}, ExitCode::output);
    write_text(frame_path(2), "");
    full({}, ExitCode::partial);
}

TEST_F(Batch, TheReportOfARunWhoseTraceCannotBeWrittenSaysSo) {
    write_frames(1, 1);
    fs::create_symlink("/dev/full", folder_ / "trace.json");
    run({"nothing.json", "in_####.exr", "-o", "out_####.exr", "--report", "report.json", "--trace",
         "trace.json"},
        int(ExitCode::output));
    const auto report = nlohmann::json::parse(read_text(folder_ / "report.json"));
    EXPECT_EQ(report["exit_code"], 6);
    EXPECT_NE(report.value("error", "").find("/dev/full"), std::string::npos) << report;
}

TEST_F(Batch, AWarmupIsNotMeasuredOnFramesThatCannotBeRead) {
    write_frames(1, 4);
    const std::vector<std::string> words{"check",         "trail.json", "--warmup",  "in_####.exr",
                                         "--effect-path", "effects",    "--backend", "software"};
    const CommandResult sound = run_aftershade(words, folder_.path());
    EXPECT_NE(sound.out.find("against all 3 before it"), std::string::npos) << sound.err;
    fs::resize_file(frame_path(2), fs::file_size(frame_path(2)) / 2);
    const CommandResult result = run_aftershade(words, folder_.path());
    EXPECT_EQ(result.exit_code, int(ExitCode::capture)) << result.err;
    EXPECT_TRUE(says(result, "in_0002.exr.*measured on frames that can all be read")) << result.err;
}

TEST_F(Batch, BytesDoNotHangOnHowTheLookIsNamed) {
    write_frames(1, 1);
    const auto bytes_of = [&](const std::string& look) {
        run({look, "in_####.exr", "-o", "out_####.exr", "--overwrite", "--no-journal"}, 0);
        return read_text(folder_ / "out_0001.exr");
    };
    const std::string bytes = bytes_of("nothing.json");
    EXPECT_EQ(bytes_of("./nothing.json"), bytes);
    EXPECT_EQ(bytes_of((folder_ / "nothing.json").string()), bytes);
}

TEST_F(Batch, AMissingFrameOfAPatternIsSkippedOrHeldWhereThatIsAskedFor) {
    write_frames(1, 3);
    fs::remove(frame_path(2));
    const CommandResult skipped =
        run({"nothing.json", "in_####.exr", "-o", "out_####.exr", "--missing", "skip"}, 0);
    EXPECT_EQ(skipped.out, "out_0001.exr\nout_0003.exr\n");
    EXPECT_TRUE(says(skipped, "frame 2 is missing: skipped")) << skipped.err;
    const std::vector<std::string> again{"nothing.json", "in_####.exr", "-o",       "out_####.exr",
                                         "--missing",    "skip",        "--report", "report.json"};
    EXPECT_EQ(run(again, 0).out, "") << "frames 1 and 3 are current, and nothing is left to do";
    EXPECT_NE(read_text(folder_ / "report.json").find("\"exit_code\": 0"), std::string::npos)
        << read_text(folder_ / "report.json");
    const CommandResult held =
        run({"nothing.json", "in_####.exr", "-o", "out_####.exr", "--missing", "hold"}, 0);
    EXPECT_EQ(held.out, "out_0002.exr\n") << "frames 1 and 3 are current";
    EXPECT_TRUE(says(held, "frame 2 is missing: held")) << held.err;
}

TEST_F(Batch, ARunThatEndsEarlyReplacesTheReportOfAnEarlierOne) {
    write_frames(1, 1);
    const auto run_with = [&](std::vector<std::string> more, int code) {
        more.insert(more.end(), {"-o", "out.exr", "--report", "report.json"});
        run(more, code);
        return nlohmann::json::parse(read_text(folder_ / "report.json"));
    };
    EXPECT_EQ(run_with({"nothing.json", "in_0001.exr"}, 0)["done"], 1);
    write_text(folder_ / "faulty.json", R"({"aftershade": 1, "steps": [{"effect": "nope"}]})");
    const auto faulty = run_with({"faulty.json", "in_0001.exr"}, int(ExitCode::usage));
    EXPECT_EQ(faulty["look"], "faulty.json");
    EXPECT_EQ(faulty["exit_code"], 2);
    EXPECT_EQ(faulty["done"], 0);
    EXPECT_NE(faulty["error"].get<std::string>().find("no effect 'nope'"), std::string::npos);
    write_text(folder_ / "in_0002.exr", "no picture");
    EXPECT_EQ(run_with({"nothing.json", "in_0002.exr"}, int(ExitCode::capture))["exit_code"], 3);
    // A fault that only quotes the option is no fault of its name.
    EXPECT_EQ(run_with({"nothing.json", "in_0001.exr", "--var", "x --report report.json"},
                       int(ExitCode::usage))["exit_code"],
              2);
    // What is no report is not removed.
    write_text(folder_ / "notes.json", "{}");
    run({"faulty.json", "in_0001.exr", "-o", "out.exr", "--report", "notes.json"}, int(ExitCode::usage));
    EXPECT_EQ(read_text(folder_ / "notes.json"), "{}");
}

TEST_F(Batch, ARunThatFellBackToSoftwareQuotesWhy) {
    const CommandResult doctor = run_aftershade({"doctor", "--json"}, folder_.path());
    const auto backends = nlohmann::json::parse(doctor.out)["backends"];
    if (backends[0]["usable"]) GTEST_SKIP() << "hardware GL works here";
    const std::string why = "egl: " + backends[0]["reason"].get<std::string>();
    write_frames(1, 1);
    const CommandResult result = run_aftershade({"run", "nothing.json", "in_0001.exr", "-o", "out.exr",
                                                 "--backend", "auto", "--report", "report.json"},
                                                folder_.path());
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_NE(result.err.find("; backend auto found no usable hardware GL (" + why + ")\n"),
              std::string::npos)
        << result.err;
    const auto report = nlohmann::json::parse(read_text(folder_ / "report.json"));
    EXPECT_EQ(report["hardware_not_usable"], true);
    EXPECT_EQ(report["hardware_fault"], why);
    run({"nothing.json", "in_0001.exr", "-o", "out.exr", "--report", "report.json"}, 0);
    EXPECT_FALSE(nlohmann::json::parse(read_text(folder_ / "report.json")).contains("hardware_fault"))
        << "software was asked for";
}

TEST_F(Batch, ASequenceOnTwosIsWholeAndSaysThatItIsOnTwos) {
    write_frames(1, 5);
    for (const int frame : {2, 4}) fs::remove(frame_path(frame));
    const CommandResult result = run({"nothing.json", "in_####.exr", "-o", "out_####.exr"}, 0);
    EXPECT_EQ(result.out, "out_0001.exr\nout_0003.exr\nout_0005.exr\n");
    EXPECT_TRUE(says(result, "warning: only every 2nd frame of 1-5 is there.*--frames 1-5")) << result.err;
}

TEST_F(Batch, AStrayNumberIsNoMillionOfMissingFrames) {
    write_frames(1, 2);
    fs::copy_file(frame_path(1), folder_ / "in_20240101.exr");
    const CommandResult result =
        run({"nothing.json", "in_####.exr", "-o", "out_####.exr"}, int(ExitCode::usage));
    EXPECT_TRUE(says(result, "20240098 frames of 1-20240101 are missing; .*--frames")) << result.err;
}

TEST_F(Batch, HistoryBegunInTheMiddleOfAShotIsReportedWithItsRemedy) {
    write_frames(1, 4);
    const std::string warning =
        "aftershade: warning: frame 3: the history of 'trail' restarts here, although frame 2 is there; "
        ".* "
        "\\(run the frames up to 2 with --history-out FILE, and these with --history-in FILE\\)";
    const auto chunk = [&](std::vector<std::string> more) {
        more.insert(more.begin(), {"trail.json", "in_####.exr", "-o", "out_####.exr"});
        return run(more, 0);
    };
    EXPECT_TRUE(says(chunk({"--frames", "3-4"}), warning));
    EXPECT_TRUE(says(chunk({"--frames", "3-4", "--jobs", "2", "--warmup", "1", "--overwrite"}), warning));
    EXPECT_TRUE(
        says(chunk({"--frames", "1-4", "--jobs", "2", "--warmup", "0", "--overwrite"}),
             "frame 3: the history of 'trail' restarts here, .*\\(leave --jobs out, or set --warmup\\)"));
    EXPECT_FALSE(says(chunk({"--frames", "1-2", "--history-out", "h"}), "warning"));
    EXPECT_FALSE(says(chunk({"--frames", "3-4", "--history-in", "h"}), "warning"));
    EXPECT_FALSE(
        says(run({"nothing.json", "in_####.exr", "-o", "out_####.exr", "--frames", "3-4"}, 0), "history"))
        << "no step has history";
    write_text(folder_ / "capture.json",
               R"({ "aftershade": 1, "frames": "in_####.exr", "range": "1-4", "cuts": [3] })");
    EXPECT_FALSE(
        says(run({"trail.json", "capture.json", "-o", "out_####.exr", "--frames", "3-4"}, 0), "warning"))
        << "a cut begins history in any case";
}

TEST_F(Batch, AnEmptyValueIsRefusedBeforeItMeansEverything) {
    write_frames(1, 2);
    for (const char* option :
         {"--frames", "--profile", "--view", "--layer", "--region", "--history-in", "--history-out",
          "--telemetry", "--set", "--var", "--output-roles", "--effect-path", "--backend", "-o"}) {
        for (const bool joined : {false, true}) {
            if (joined && option[1] != '-') continue;
            std::vector<std::string> arguments{"nothing.json", "in_####.exr", "-o", "out_####.exr"};
            if (joined) arguments.push_back(std::string(option) + "=");
            else arguments.insert(arguments.end(), {option, ""});
            arguments.insert(arguments.begin(), "run");
            const CommandResult result = run_aftershade(arguments, folder_.path());
            EXPECT_EQ(result.exit_code, int(ExitCode::usage)) << option << joined;
            EXPECT_EQ(result.out, "") << option << joined;
            EXPECT_TRUE(says(result, "the value is empty|required TEXT missing"))
                << option << joined << result.err;
        }
    }
    EXPECT_TRUE(
        says(run({"nothing.json", "in_####.exr", "-o", "out_####.exr", "--frames", ""}, int(ExitCode::usage)),
             "--frames: the value is empty; leave the option out, or set the variable"));
    EXPECT_TRUE(says(run({"", "in_####.exr", "-o", "out_####.exr"}, int(ExitCode::usage)),
                     "look: the value is empty"));
}

TEST_F(Batch, ASaveDuringTheFirstRenderOfAWatchIsRendered) {
    constexpr int kFrames = 6;
    write_frames(1, kFrames, 480, 270);
    Command watch(aftershade_words(words({"spread.json", "in_####.exr", "-o", "out_####.exr", "--watch"})),
                  folder_.path());
    ASSERT_TRUE(watch.wait_for_lines(1));
    write_text(folder_ / "spread.json", R"({ "aftershade": 1, "steps": [ { "effect": "trail" } ] })");
    EXPECT_TRUE(watch.wait_for_lines(2 * kFrames)) << "the save was lost";
    watch.send(SIGINT);
    EXPECT_EQ(watch.wait().exit_code, int(ExitCode::interrupted));
    const std::string watched = read_text(folder_ / "out_0006.exr");
    // A watched look keeps no journal, and its outputs carry no fingerprint.
    run({"spread.json", "in_####.exr", "-o", "out_####.exr", "--no-journal"}, 0);
    EXPECT_EQ(watched, read_text(folder_ / "out_0006.exr"));
}

}  // namespace
}  // namespace aftershade::test
