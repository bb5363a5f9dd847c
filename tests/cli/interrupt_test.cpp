// SIGINT, SIGTERM and SIGKILL in the middle of a run, and how it goes on.
#include <chrono>
#include <thread>

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
    CommandResult interrupted(const std::vector<std::string>& arguments, int signal) {
        Command command(aftershade_words(arguments), folder_.path());
        EXPECT_TRUE(command.wait_for_lines(3));
        command.send(signal);
        CommandResult result = command.wait();
        EXPECT_EQ(result.exit_code, int(ExitCode::interrupted)) << result.err;
        EXPECT_TRUE(temporaries().empty());
        return result;
    }
    /// The line that it prints, as a shell runs it.
    CommandResult go_on(const CommandResult& result) {
        const auto lines = lines_of_text(result.err);
        for (std::size_t i = 0; i + 1 < lines.size(); ++i)
            if (lines[i].starts_with("interrupted after ")) {
                EXPECT_EQ(lines[i + 1].find("  "), 0u) << "a line of its own";
                return Command({"/bin/sh", "-c", lines[i + 1]}, folder_.path()).wait();
            }
        ADD_FAILURE() << "no command to resume\n" << result.err;
        return {};
    }
};

TEST_F(Interruption, PrintsTheCommandThatRendersTheRest) {
    const auto whole = undisturbed("spread.json");
    const CommandResult first = interrupted(sequence("spread.json"), SIGINT);
    const std::size_t done = lines_of_text(first.out).size();
    ASSERT_LT(done, std::size_t(kFrames));
    EXPECT_EQ(outputs().size(), done);
    const CommandResult rest = go_on(first);
    EXPECT_EQ(rest.exit_code, 0) << rest.err;
    EXPECT_EQ(lines_of_text(rest.out).size(), kFrames - done) << "nothing was rendered twice";
    EXPECT_EQ(outputs(), whole);
}

TEST_F(Interruption, GoesOnWithItsHistoryToTheBit) {
    const auto whole = undisturbed("trail.json");
    const CommandResult first =
        interrupted(sequence("trail.json", {"--frames=1-120", "--history-out", "the history"}), SIGTERM);
    const std::size_t done = lines_of_text(first.out).size();
    const CommandResult rest = go_on(first);
    EXPECT_EQ(rest.exit_code, 0) << rest.err;
    EXPECT_EQ(rest.err.find("warning"), std::string::npos) << rest.err;
    EXPECT_EQ(lines_of_text(rest.out).size(), kFrames - done);
    EXPECT_EQ(outputs(), whole);
}

TEST_F(Interruption, BeginsTheShotAgainWhereItsHistoryWasNotKept) {
    write_text(folder_ / "capture.json",
               R"({ "aftershade": 1, "frames": "in_####.exr", "range": "1-120", "cuts": [3] })");
    std::vector<std::string> arguments = sequence("trail.json");
    arguments[2] = "capture.json";
    run_aftershade(arguments, folder_.path());
    const auto whole = outputs();
    for (const auto& [name, bytes] : whole) fs::remove(folder_ / name);
    const CommandResult first = interrupted(arguments, SIGINT);
    EXPECT_NE(first.err.find("--frames 3-120"), std::string::npos) << first.err;
    EXPECT_NE(first.err.find("--history-out keeps it"), std::string::npos) << first.err;
    EXPECT_EQ(go_on(first).exit_code, 0);
    EXPECT_EQ(outputs(), whole);
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
