// Runs that leave out what earlier ones have written, against runs that nobody disturbed.
#include <algorithm>
#include <filesystem>
#include <set>

#include "framework/batch/process_codes.h"
#include "tests/cli/batch_work.h"

namespace aftershade::test {
namespace {

namespace fs = std::filesystem;

constexpr int kFrames = 6;

class Resume : public BatchWork {
protected:
    Resume() {
        for (int frame = 1; frame <= kFrames; ++frame) write_input(frame, 0.1f);
        write_tint("now");
    }

    void write_input(int frame, float red) const {
        SyntheticScene scene{
            .width = 64, .height = 36, .background = {red, 0.2f, 0.4f}, .background_depth_m = 8};
        scene.box = SyntheticBox{4, 6, 16, 12, 5, 2};
        write_capture(make_capture(scene, frame), frame_path(frame));
    }
    /// `now` is what of the pixel the gain multiplies.
    void write_tint(const std::string& now) const {
        write_effect(
            "tint",
            R"("params": { "gain": { "type": "float", "default": 2, "min": 0, "max": 9, "doc": "." } },
            "passes": [ { "name": "main", "shader": "main.frag", "reads": ["color"], "writes": ["color"] } ])",
            "vec4 now = texelFetch(color, p, 0); out_color = " + now + " * param.gain;");
    }

    CommandResult run(const std::string& look, const std::vector<std::string>& more = {},
                      const std::string& outputs = "out_####.exr", int exit_code = 0) const {
        CommandResult result = run_aftershade(words(look, more, outputs), folder_.path());
        EXPECT_EQ(result.exit_code, exit_code) << result.err;
        return result;
    }
    static std::vector<std::string> words(const std::string& look, const std::vector<std::string>& more,
                                          const std::string& outputs = "out_####.exr") {
        std::vector<std::string> words{"run",       look + ".json", "in_####.exr", "--effect-path", "effects",
                                       "--backend", "software",     "-o",          outputs};
        words.insert(words.end(), more.begin(), more.end());
        return words;
    }
    std::string dry_run(const std::string& look, std::vector<std::string> more = {}) const {
        const auto before = contents(folder_.path());
        more.emplace_back("--dry-run");
        std::string out = run(look, more).out;
        EXPECT_EQ(contents(folder_.path()), before) << "--dry-run wrote something";
        return out;
    }

    /// The bytes of the outputs of these names, by the number's text.
    std::map<std::string, std::string> outputs(const std::string& begin) const {
        std::map<std::string, std::string> files;
        for (const auto& entry : fs::directory_iterator(folder_.path()))
            if (const std::string name = entry.path().filename().string(); name.starts_with(begin))
                files[name.substr(begin.size())] = read_text(entry.path());
        return files;
    }
    void expect_equals_undisturbed_run(const std::string& look) const {
        run(look, {}, "whole_####.exr");
        EXPECT_EQ(outputs("out_"), outputs("whole_"));
    }
    bool has_checkpoints() const { return fs::exists(folder_ / ".aftershade/history"); }
};

TEST_F(Resume, ASecondRunLeavesEveryFrameAlone) {
    const CommandResult first = run("tint");
    EXPECT_EQ(lines_of_text(first.out).size(), 6u);
    EXPECT_EQ(first.err.find("current"), std::string::npos) << first.err;
    const auto before = contents(folder_.path());
    const CommandResult second = run("tint");
    EXPECT_EQ(second.out, "");
    EXPECT_NE(second.err.find("6 frames: 6 current, 0 to render"), std::string::npos) << second.err;
    EXPECT_EQ(contents(folder_.path()), before);
}

TEST_F(Resume, OutputsCarryTheirFingerprintAndTheJournalHasIt) {
    run("tint");
    const std::string journal = read_text(folder_ / ".aftershade/journal.jsonl");
    std::set<std::string> fingerprints;
    for (int frame = 1; frame <= kFrames; ++frame) {
        const ExrFile file(folder_ / ("out_000" + std::to_string(frame) + ".exr"));
        const auto fingerprint = file.parts()[0].metadata.text("aftershade/fingerprint");
        ASSERT_TRUE(fingerprint);
        EXPECT_EQ(fingerprint->size(), 32u);
        EXPECT_NE(journal.find(*fingerprint), std::string::npos);
        fingerprints.insert(*fingerprint);
    }
    EXPECT_EQ(fingerprints.size(), 6u);
}

TEST_F(Resume, RendersTheFramesWhoseInputsChangedAndNoOthers) {
    run("tint");
    write_input(2, 0.9f);
    fs::remove(folder_ / "out_0005.exr");
    EXPECT_EQ(dry_run("tint"),
              "frame 2: input in_0002.exr changed\nframe 5: output out_0005.exr is missing\n"
              "6 frames: 4 current, 2 to render\n");
    const CommandResult result = run("tint");
    EXPECT_EQ(result.out, "out_0002.exr\nout_0005.exr\n");
    EXPECT_NE(result.err.find("6 frames: 4 current, 2 to render"), std::string::npos) << result.err;
    expect_equals_undisturbed_run("tint");
}

TEST_F(Resume, SaysWhyFramesAreNotCurrent) {
    EXPECT_EQ(lines_of_text(dry_run("tint")).front(), "frame 1: not rendered yet");
    run("tint");
    EXPECT_EQ(dry_run("tint"), "6 frames: 6 current, 0 to render\n");
    EXPECT_EQ(lines_of_text(dry_run("tint", {"--set", "tint.gain=3"})).front(),
              "frame 1: values of tint changed");
    EXPECT_EQ(lines_of_text(dry_run("tint", {"--pixel-type", "float"})).front(),
              "frame 1: output options changed");
    EXPECT_EQ(lines_of_text(dry_run("tint", {"--overwrite"})).front(),
              "frame 1: --overwrite renders every frame");
    EXPECT_EQ(lines_of_text(dry_run("tint", {"--tap", "tint.color"})).front(),
              "frame 1: output out.tint.color.0001.exr is missing");
    write_tint("now.bgra");
    EXPECT_EQ(lines_of_text(dry_run("tint")).front(), "frame 1: effect tint changed");
    write_text(folder_ / "out_0006.exr", "another file");
    EXPECT_EQ(lines_of_text(dry_run("tint"))[5], "frame 6: output out_0006.exr changed");
    fs::remove(folder_ / ".aftershade/journal.jsonl");
    EXPECT_EQ(lines_of_text(dry_run("tint")).front(),
              "frame 1: the journal does not record how out_0001.exr was made");
}

TEST_F(Resume, ACopyOfTheFolderIsAsCurrentAsTheFolder) {
    fs::create_directory(folder_ / "made");
    run("tint", {}, "made/out_####.exr");
    fs::copy(folder_ / "made", folder_ / "copy", fs::copy_options::recursive);  // other times
    const CommandResult result = run("tint", {}, "copy/out_%04d.exr");
    EXPECT_EQ(result.out, "");
    EXPECT_NE(result.err.find("6 current"), std::string::npos) << result.err;
}

TEST_F(Resume, FramesThatAreAddedLeaveTheOthersAlone) {
    run("tint", {"--frames", "1-4"});
    EXPECT_EQ(run("tint").out, "out_0005.exr\nout_0006.exr\n");
    EXPECT_EQ(run("tint", {"--frames", "2-5"}).out, "");
}

TEST_F(Resume, ARunOfOneFrameRendersItUnlessResumeIsGiven) {
    for (int i = 0; i < 2; ++i) EXPECT_EQ(run("tint", {"--frames", "3"}).out, "out_0003.exr\n");
    EXPECT_FALSE(fs::exists(folder_ / ".aftershade"));
    EXPECT_EQ(run("tint", {"--frames", "3", "--resume"}).out, "out_0003.exr\n");
    EXPECT_EQ(run("tint", {"--frames", "3", "--resume"}).out, "");
    EXPECT_EQ(run("tint", {"--frames", "3", "--resume", "--overwrite"}).out, "out_0003.exr\n");
}

TEST_F(Resume, WithoutAJournalEveryRunRendersAll) {
    for (int i = 0; i < 2; ++i) EXPECT_EQ(lines_of_text(run("tint", {"--no-journal"}).out).size(), 6u);
    EXPECT_FALSE(fs::exists(folder_ / ".aftershade"));
    EXPECT_FALSE(
        ExrFile(folder_ / "out_0001.exr").parts()[0].metadata.text("aftershade/fingerprint").has_value());
}

TEST_F(Resume, AChangedFrameMakesThoseThatContinueItsHistoryStale) {
    write_text(folder_ / "capture.json",
               R"({ "aftershade": 1, "frames": "in_####.exr", "range": "1-6", "cuts": [5] })");
    const auto film = [&](std::vector<std::string> more) {
        std::vector<std::string> all = words("trail", more);
        all[2] = "capture.json";
        return run_aftershade(all, folder_.path());
    };
    film({});
    write_input(3, 0.9f);
    EXPECT_EQ(film({"--dry-run"}).out,
              "frame 3: input in_0003.exr changed\n"
              "frame 4: the frame before it changed, whose history it continues\n"
              "6 frames: 4 current, 2 to render; 2 of the current ones rendered again, but not written, for "
              "the frames after them\n");
    EXPECT_EQ(film({}).out, "out_0003.exr\nout_0004.exr\n");
    std::vector<std::string> whole = words("trail", {}, "whole_####.exr");
    whole[2] = "capture.json";
    run_aftershade(whole, folder_.path());
    EXPECT_EQ(outputs("out_"), outputs("whole_"));
}

TEST_F(Resume, GoesOnFromTheNewestCheckpointAndGivesTheSameBits) {
    const std::string sound = read_text(folder_ / "in_0006.exr");
    write_text(folder_ / "in_0006.exr", sound.substr(0, sound.size() / 2));
    run("trail", {"--checkpoint", "2"}, "out_####.exr", int(ExitCode::partial));
    const auto saved = [&] {
        std::set<std::string> names;
        for (const auto& entry : fs::recursive_directory_iterator(folder_ / ".aftershade/history"))
            if (entry.is_regular_file()) names.insert(entry.path().filename().string());
        return names;
    };
    EXPECT_EQ(saved(), (std::set<std::string>{"0002.history", "0004.history"}));
    write_text(folder_ / "in_0006.exr", sound);
    const CommandResult result = run("trail", {"--checkpoint", "2"});
    EXPECT_EQ(result.out, "out_0006.exr\n");
    EXPECT_EQ(result.err.find("frame 4 ("), std::string::npos) << result.err;
    EXPECT_NE(result.err.find("frame 5 (1/2)"), std::string::npos) << result.err;
    EXPECT_FALSE(has_checkpoints());
    expect_equals_undisturbed_run("trail");
}

TEST_F(Resume, ACheckpointOfOtherValuesIsNotTaken) {
    const std::string sound = read_text(folder_ / "in_0006.exr");
    write_text(folder_ / "in_0006.exr", sound.substr(0, sound.size() / 2));
    run("trail", {"--checkpoint", "2"}, "out_####.exr", int(ExitCode::partial));
    write_text(folder_ / "in_0006.exr", sound);
    write_input(2, 0.7f);  // before the newest checkpoint
    EXPECT_EQ(lines_of_text(run("trail", {"--checkpoint", "2"}).out).size(), 5u);
    expect_equals_undisturbed_run("trail");
}

TEST_F(Resume, WithoutCheckpointsHistoryIsRenderedFromTheFirstFrame) {
    run("trail", {"--checkpoint", "0"});
    fs::remove(folder_ / "out_0004.exr");
    const CommandResult result = run("trail", {"--checkpoint", "0"});
    EXPECT_EQ(result.out, "out_0004.exr\n");
    EXPECT_NE(result.err.find("frame 1 (1/4)"), std::string::npos) << result.err;
    expect_equals_undisturbed_run("trail");
}

TEST_F(Resume, ChunksThatHandOnTheirHistoryHaveTheFingerprintsOfOneRun) {
    run("trail", {"--frames", "1-3", "--history-out", "h"});
    run("trail", {"--frames", "4-6", "--history-in", "h"});
    EXPECT_EQ(run("trail").out, "");
    expect_equals_undisturbed_run("trail");
    fs::remove(folder_ / "h");
    EXPECT_EQ(run("trail", {"--frames", "1-3", "--history-out", "h"}).out, "");
    EXPECT_TRUE(fs::exists(folder_ / "h")) << "what the run was asked for, though its frames are current";
    EXPECT_EQ(run("trail", {"--frames", "4-6", "--history-in", "h"}).out, "");
}

TEST_F(Resume, AHeldFrameIsRenderedWithTheFrameThatItHolds) {
    const auto film = [&](const std::string& names) {
        return run("tint", {"--frames", "1-6", "--missing", "hold"}, names);
    };
    fs::remove(folder_ / "in_0004.exr");
    film("out_####.exr");
    fs::remove(folder_ / "out_0004.exr");
    EXPECT_EQ(film("out_####.exr").out, "out_0004.exr\n");
    film("whole_####.exr");
    EXPECT_EQ(outputs("out_"), outputs("whole_"));
    write_input(3, 0.8f);
    EXPECT_EQ(film("out_####.exr").out, "out_0003.exr\nout_0004.exr\n");
}

TEST_F(Resume, AFrameThatCouldNotBeReadIsTriedAgain) {
    const std::string sound = read_text(folder_ / "in_0003.exr");
    write_text(folder_ / "in_0003.exr", sound.substr(0, sound.size() / 2));
    run("tint", {}, "out_####.exr", int(ExitCode::partial));
    const CommandResult again =
        run("tint", {"--report", "report.json"}, "out_####.exr", int(ExitCode::partial));
    EXPECT_EQ(again.out, "");
    EXPECT_NE(read_text(folder_ / "report.json").find("\"exit_code\": 1"), std::string::npos)
        << read_text(folder_ / "report.json");
    EXPECT_NE(again.err.find("6 frames: 5 current, 1 to render"), std::string::npos) << again.err;
    write_text(folder_ / "in_0003.exr", sound);
    EXPECT_EQ(run("tint").out, "out_0003.exr\n");
}

TEST_F(Resume, ResumesAfterAKillWithTheSameBits) {
    constexpr int kMany = 60;
    for (int frame = kFrames + 1; frame <= kMany; ++frame)
        write_capture(
            make_capture(SyntheticScene{.width = 64, .height = 36, .background = {0.01f * float(frame)}},
                         frame),
            FramePattern((folder_ / "in_####.exr").string()).path(frame));
    Command command(aftershade_words(words("trail", {"--checkpoint", "5"})), folder_.path(),
                    {{"AFTERSHADE_BACKEND", "software"}});
    ASSERT_TRUE(command.wait_for_lines(12));
    command.send(SIGKILL);
    EXPECT_EQ(command.wait().exit_code, 128 + SIGKILL);
    EXPECT_TRUE(has_checkpoints());
    const CommandResult result = run("trail", {"--checkpoint", "5"});
    const std::size_t written = lines_of_text(result.out).size();
    EXPECT_LE(written, std::size_t(kMany - 12));
    int rendered = 0;
    for (const std::string& line : lines_of_text(result.err))
        rendered += line.starts_with("frame ") && line.ends_with(")") ? 1 : 0;
    EXPECT_LE(std::size_t(rendered), written + 2 * 5) << result.err;
    EXPECT_FALSE(has_checkpoints());
    std::error_code ignored;
    for (const auto& entry : fs::directory_iterator(folder_.path()))
        if (entry.path().extension() == ".tmp") fs::remove(entry.path(), ignored);
    expect_equals_undisturbed_run("trail");
}

TEST_F(Resume, ASecondRunOverTheSameFramesNamesWhoHasThem) {
    constexpr int kMany = 300;
    for (int frame = 1; frame <= kMany; ++frame)
        fs::create_hard_link(folder_ / "in_0001.exr",
                             FramePattern((folder_ / "many_####.exr").string()).path(frame));
    std::vector<std::string> all = words("tint", {});
    all[2] = "many_####.exr";
    Command command(aftershade_words(all), folder_.path(), {{"AFTERSHADE_BACKEND", "software"}});
    ASSERT_TRUE(command.wait_for_lines(1));
    all.insert(all.end(), {"--frames", "290-320"});
    const CommandResult second = run_aftershade(all, folder_.path());
    EXPECT_EQ(second.exit_code, int(ExitCode::output)) << second.err;
    EXPECT_EQ(second.out, "");
    for (const char* part : {"out_####.exr: another run is writing frames 290-320 of this output", "process ",
                             " on host ", " since ", "frames 1-300", "wait for it or end it"})
        EXPECT_NE(second.err.find(part), std::string::npos) << part << "\n" << second.err;
    // Other frames of the same output, as a farm's chunks have, and other outputs are free.
    run("tint", {"--frames", "5-6"}, "other_####.exr");
    command.send(SIGTERM);
    EXPECT_EQ(command.wait().exit_code, int(ExitCode::interrupted));
    EXPECT_EQ(run_aftershade({"run", "tint.json", "many_####.exr", "--effect-path", "effects", "-o",
                              "out_####.exr", "--frames", "299-300"},
                             folder_.path())
                  .exit_code,
              0);
}

}  // namespace
}  // namespace aftershade::test
