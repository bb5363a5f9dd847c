// SIGINT, SIGTERM and SIGKILL in the middle of a run, and how it goes on.
#include <chrono>
#include <nlohmann/json.hpp>
#include <thread>

#include "framework/batch/process_codes.h"
#include "tests/cli/batch_work.h"

namespace aftershade::test {
namespace {

namespace fs = std::filesystem;

constexpr int kFrames = 120;

class Interruption : public BatchWork {
protected:
    Interruption() { write_frames(1, kFrames); }

    static std::vector<std::string> sequence(const std::string& look, std::vector<std::string> more = {}) {
        more.insert(more.begin(), {look, "in_####.exr", "-o", "out_####.exr"});
        return words(more);
    }
    std::map<std::string, std::string> outputs() const {
        std::map<std::string, std::string> files;
        for (const auto& [name, bytes] : contents(folder_.path()))
            if (name.starts_with("out_")) files[name] = bytes;
        return files;
    }
    std::map<std::string, std::string> undisturbed(const std::string& look) {
        run_aftershade(sequence(look), folder_.path());
        const auto files = outputs();
        for (const auto& [name, bytes] : files) fs::remove(folder_ / name);
        EXPECT_EQ(files.size(), std::size_t(kFrames));
        return files;
    }
    CommandResult interrupted(const std::vector<std::string>& arguments, int signal,
                              const Environment& environment = {}) {
        Command command(aftershade_words(arguments), folder_.path(), environment);
        EXPECT_TRUE(command.wait_for_lines(3));
        command.send(signal);
        CommandResult result = command.wait();
        EXPECT_EQ(result.exit_code, int(ExitCode::interrupted)) << result.err;
        EXPECT_TRUE(temporaries().empty());
        return result;
    }
    static std::string last_line(const CommandResult& result) {
        const auto lines = lines_of_text(result.err);
        return lines.empty() ? "" : lines.back();
    }
    /// Runs what it prints last, as it is, in a shell that stands elsewhere and knows nothing of the run.
    static CommandResult go_on(const CommandResult& result) {
        EXPECT_EQ(last_line(result).find("  cd "), 0U) << result.err;
        EXPECT_EQ(result.err.find("to resume"), result.err.rfind("to resume")) << result.err;
        return Command({"/bin/bash", "-c", last_line(result)}, "/").wait();
    }
};

TEST_F(Interruption, PrintsTheCommandThatRendersTheRest) {
    const auto whole = undisturbed("spread.json");
    fs::remove_all(folder_ / ".aftershade");
    const CommandResult first = interrupted(sequence("spread.json"), SIGINT);
    const std::size_t done = lines_of_text(first.out).size();
    ASSERT_LT(done, std::size_t(kFrames));
    EXPECT_EQ(outputs().size(), done);
    EXPECT_NE(first.err.find("interrupted after " + std::to_string(done) + " of 120 frames; to resume:\n  "),
              std::string::npos)
        << first.err;
    const CommandResult rest = go_on(first);
    EXPECT_EQ(rest.exit_code, 0) << rest.err;
    EXPECT_EQ(lines_of_text(rest.out).size(), kFrames - done) << "nothing was rendered twice";
    EXPECT_EQ(outputs(), whole);
}

TEST_F(Interruption, GoesOnWithItsHistoryToTheBit) {
    const std::vector<std::string> arguments =
        sequence("trail.json", {"--frames=1-120", "--history-out", "the history"});
    ASSERT_EQ(run_aftershade(arguments, folder_.path()).exit_code, 0);
    const auto whole = contents(folder_.path());
    for (const auto& [name, bytes] : outputs()) fs::remove(folder_ / name);
    fs::remove(folder_ / "the history");
    fs::remove_all(folder_ / ".aftershade");
    const CommandResult first = interrupted(arguments, SIGTERM);
    EXPECT_FALSE(fs::exists(folder_ / "the history")) << "of some frames it would pass for that of all";
    EXPECT_NE(first.err.find("from the last checkpoint or the beginning of the shot"), std::string::npos)
        << first.err;
    const std::size_t done = lines_of_text(first.out).size();
    const CommandResult rest = go_on(first);
    EXPECT_EQ(rest.exit_code, 0) << rest.err;
    EXPECT_EQ(rest.err.find("warning"), std::string::npos) << rest.err;
    EXPECT_EQ(lines_of_text(rest.out).size(), kFrames - done);
    auto found = contents(folder_.path());
    found[".aftershade/journal.jsonl"] = whole.at(".aftershade/journal.jsonl");  // with times
    EXPECT_EQ(found, whole);
}

TEST_F(Interruption, OfAResumedRunBeforeItsFirstNewFrameKeepsTheHistory) {
    const auto whole = undisturbed("trail.json");
    fs::remove_all(folder_ / ".aftershade");
    const CommandResult first = interrupted(sequence("trail.json"), SIGINT);
    const std::size_t done = outputs().size();
    Command second(aftershade_words(sequence("trail.json")), folder_.path());
    ASSERT_TRUE(second.wait_until_it_handles(SIGINT));
    second.send(SIGINT);
    const CommandResult again = second.wait();
    ASSERT_EQ(again.exit_code, int(ExitCode::interrupted)) << again.err;
    ASSERT_EQ(outputs().size(), done);
    EXPECT_EQ(go_on(again).exit_code, 0);
    EXPECT_EQ(outputs(), whole);
}

TEST_F(Interruption, OfAChunkPrintsItsNumberAndTheVariablesThatItReads) {
    ASSERT_EQ(
        run_aftershade(sequence("trail.json", {"--chunk", "2/3", "--warmup", "4"}), folder_.path()).exit_code,
        0);
    const auto whole = outputs();
    for (const auto& [name, bytes] : whole) fs::remove(folder_ / name);
    fs::remove_all(folder_ / ".aftershade");
    const CommandResult first =
        interrupted(sequence("trail.json", {"--chunk", "auto/3", "--warmup", "4"}), SIGTERM,
                    {{"JOB_COMPLETION_INDEX", "1"}, {"AFTERSHADE_ALLOW_PATH", "/it's here"}});
    EXPECT_NE(last_line(first).find("AFTERSHADE_ALLOW_PATH='/it'\\''s here'"), std::string::npos);
    EXPECT_NE(last_line(first).find("--chunk 2/3"), std::string::npos);
    EXPECT_EQ(last_line(first).find("auto"), std::string::npos);
    EXPECT_EQ(go_on(first).exit_code, 0);
    EXPECT_EQ(outputs(), whole);
}

TEST_F(Interruption, PrintsNamesSoThatAShellReadsThemBack) {
    const std::string odd = "it's \"a\" $HOME\n`x`";
    fs::rename(folder_ / "trail.json", folder_ / ("-" + odd));
    const auto arguments = [&](const std::string& out) {
        return std::vector<std::string>{"run",           "-o",      out + "/out_####.exr",
                                        "--effect-path", "effects", "--backend",
                                        "software",      "--jobs",  "2",
                                        "--warmup=3",    "--",      "-" + odd,
                                        "in_####.exr"};
    };
    ASSERT_EQ(run_aftershade(arguments("whole"), folder_.path()).exit_code, 0);
    const CommandResult first = interrupted(arguments(odd), SIGINT);
    const CommandResult rest = go_on(first);
    EXPECT_EQ(rest.exit_code, 0) << rest.err;
    auto whole = contents(folder_ / "whole"), found = contents(folder_ / odd);
    whole.erase(".aftershade/journal.jsonl");
    found.erase(".aftershade/journal.jsonl");
    EXPECT_EQ(found, whole);
}

TEST_F(Interruption, SaysWhichOptionRendersEveryFrameAgain) {
    const CommandResult first = interrupted(sequence("spread.json", {"--no-journal"}), SIGINT);
    EXPECT_NE(first.err.find("to resume, with every frame rendered again (--no-journal):"), std::string::npos)
        << first.err;
    EXPECT_EQ(go_on(first).exit_code, 0);
    EXPECT_EQ(outputs().size(), std::size_t(kFrames));
}

TEST_F(Interruption, IsAnObjectAmongObjects) {
    const CommandResult first = interrupted(sequence("spread.json", {"--progress", "json"}), SIGINT);
    for (const std::string& line : lines_of_text(first.err)) EXPECT_EQ(line[0], '{') << line;
    const auto event = nlohmann::json::parse(last_line(first));
    EXPECT_EQ(event.at("event"), "interrupted");
    EXPECT_EQ(Command({"/bin/bash", "-c", event.at("command").get<std::string>()}, "/").wait().exit_code, 0);
    EXPECT_EQ(outputs().size(), std::size_t(kFrames));
}

TEST_F(Interruption, ASecondSignalEndsItAtOnce) {
    write_frames(1, 3, 1920, 1080);
    Command command(aftershade_words(sequence("spread.json", {"--frames", "1-3"})), folder_.path());
    ASSERT_TRUE(command.wait_for_lines(1));
    command.send(SIGINT);
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    command.send(SIGTERM);
    EXPECT_EQ(command.wait().exit_code, 128 + SIGTERM) << "by the signal, not by the exit after a frame";
}

TEST_F(Interruption, TheSameSignalTwiceAtOnceIsOneInterrupt) {
    write_frames(1, 24, 480, 270);
    Command command(aftershade_words(sequence("spread.json", {"--frames", "1-24"})), folder_.path());
    ASSERT_TRUE(command.wait_for_lines(1));
    for (int i = 0; i < 3; ++i) {
        command.send(SIGTERM);
        std::this_thread::sleep_for(std::chrono::milliseconds(5 * i));
    }
    const CommandResult result = command.wait();
    EXPECT_EQ(result.exit_code, 130) << "timeout(1) signals its child and then the group";
    EXPECT_NE(result.err.find("to resume:"), std::string::npos) << result.err;
}

TEST_F(Interruption, KilledRunsLeaveTemporariesThatTheNextRunRemoves) {
    constexpr int kMostKills = 60;
    int kills = 0;
    for (; kills < kMostKills && temporaries().empty(); ++kills) {
        Command command(aftershade_words(sequence("nothing.json")), folder_.path());
        ASSERT_TRUE(command.wait_for_lines(2));
        std::this_thread::sleep_for(std::chrono::milliseconds(kills % 7));
        command.send(SIGKILL);
        EXPECT_EQ(command.wait().exit_code, 128 + SIGKILL);
    }
    ASSERT_FALSE(temporaries().empty()) << "no kill met a file that was being written";
    write_text(folder_ / ".theirs.exr.tmp", "of another program");
    EXPECT_EQ(run_aftershade(sequence("nothing.json", {"--frames", "1"}), folder_.path()).exit_code, 0);
    EXPECT_EQ(temporaries(), std::vector<std::string>{".theirs.exr.tmp"});
    for (const auto& [name, bytes] : outputs()) EXPECT_NO_THROW(color(name)) << name;
}

}  // namespace
}  // namespace aftershade::test
