// What runs keep in .aftershade: the journal and the locks.
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>

#include "framework/base/error.h"
#include "framework/run/journal.h"
#include "framework/run/run_lock.h"
#include "tests/temporary_folder.h"

namespace aftershade::test {
namespace {

namespace fs = std::filesystem;

class JournalTest : public testing::Test {
protected:
    Journal journal(const std::string& pattern = "out_####.exr") const {
        return Journal(run_state((folder_ / pattern).string()));
    }
    fs::path output(int frame) const { return folder_ / ("out_000" + std::to_string(frame) + ".exr"); }
    void add(Journal& journal, int frame, const std::string& hash) const {
        write_text(output(frame), "pixels of " + std::to_string(frame));
        journal.add(frame, hash_of_parts(parts_), {hash, {{"input a", "1"}}, "begin"}, {output(frame)}, 0.5);
    }
    std::string lines() const { return read_text(folder_ / ".aftershade/journal.jsonl"); }
    void write_lines(const std::string& text) const {
        write_text(folder_ / ".aftershade/journal.jsonl", text);
    }

    const FingerprintParts parts_{{"look", "12"}, {"program", "0.1"}};
    TemporaryFolder folder_;
};

TEST_F(JournalTest, GivesBackTheLastLineOfEachFrame) {
    Journal first = journal();
    EXPECT_EQ(first.find(1), nullptr);
    first.begin(parts_);
    add(first, 1, "old");
    add(first, 2, "two");
    add(first, 1, "new");
    const Journal second = journal();
    ASSERT_NE(second.find(1), nullptr);
    const JournalFrame& one = *second.find(1);
    EXPECT_EQ(one.fingerprint.hash, "new");
    EXPECT_EQ(one.fingerprint.inputs, (FingerprintParts{{"input a", "1"}}));
    EXPECT_EQ(one.fingerprint.before, "begin");
    EXPECT_EQ(one.seconds, 0.5);
    ASSERT_EQ(one.files.size(), 1u);
    EXPECT_EQ(one.files[0].path, "out_0001.exr");
    EXPECT_EQ(one.files[0].bytes, 11u);
    ASSERT_NE(second.setup(one.setup), nullptr);
    EXPECT_EQ(*second.setup(one.setup), parts_);
    EXPECT_EQ(second.find(3), nullptr);
}

TEST_F(JournalTest, KeepsApartTheOutputsOfOneFolder) {
    Journal exr = journal();
    exr.begin(parts_);
    add(exr, 1, "one");
    EXPECT_EQ(journal("other_####.exr").find(1), nullptr);
    EXPECT_NE(journal("out_%04d.exr").find(1), nullptr) << "the same files by another pattern";
}

TEST_F(JournalTest, PassesOverALineThatAKillCutOffAndGoesOnBehindIt) {
    Journal first = journal();
    first.begin(parts_);
    add(first, 1, "one");
    add(first, 2, "two");
    const std::string whole = lines();
    for (std::size_t end = whole.rfind("{\"before"); end < whole.size(); end += 13) {
        write_lines(whole.substr(0, end));
        Journal torn = journal();
        ASSERT_NE(torn.find(1), nullptr) << end;
        const bool is_whole = end + 1 == whole.size();
        EXPECT_EQ(torn.find(2) != nullptr, is_whole) << end;
        torn.begin(parts_);
        add(torn, 3, "three");
        const Journal after = journal();
        ASSERT_NE(after.find(3), nullptr) << end;
        EXPECT_EQ(after.find(3)->fingerprint.hash, "three");
        EXPECT_NE(after.find(1), nullptr);
    }
}

TEST_F(JournalTest, PassesOverLinesThatAreNoneOfIts) {
    Journal first = journal();
    first.begin(parts_);
    add(first, 1, "one");
    const std::string whole = lines();
    for (const char* line : {"", "null", "[1]", "{}", "{\"output\": 7}",
                             "{\"output\": \"out_#.exr\", \"frame\": 1}", "{\"setup\": 1, \"parts\": []}"}) {
        write_lines(whole + line + "\n");
        ASSERT_NE(journal().find(1), nullptr) << line;
        EXPECT_EQ(journal().find(1)->fingerprint.hash, "one") << line;
    }
}

TEST_F(JournalTest, RefusesAPipeAndADeviceInItsPlace) {
    const fs::path place = folder_ / ".aftershade/journal.jsonl";
    fs::create_directories(place.parent_path());
    ASSERT_EQ(mkfifo(place.c_str(), 0600), 0);
    EXPECT_THROW(journal(), Error);
    fs::remove(place);
    fs::create_symlink("/dev/zero", place);
    EXPECT_THROW(journal(), Error);
}

TEST_F(JournalTest, SaysWhyFilesAreNotWhatItsLineSays) {
    Journal first = journal();
    first.begin(parts_);
    add(first, 1, "one");
    const Journal now = journal();
    const auto fault = [&] { return now.fault_of_files(*now.find(1), {output(1)}); };
    EXPECT_EQ(fault(), "");
    fs::last_write_time(output(1), fs::file_time_type::clock::now() - std::chrono::hours(1));
    EXPECT_EQ(fault(), "") << "the same bytes at another time";
    write_text(output(1), "pixels of 2");
    EXPECT_EQ(fault(), "output out_0001.exr changed");
    write_text(output(1), "pixels");
    EXPECT_EQ(fault(), "output out_0001.exr changed");
    fs::remove(output(1));
    EXPECT_EQ(fault(), "output out_0001.exr is missing");
    write_text(output(2), "by another program");
    EXPECT_EQ(now.fault_of_files(*now.find(1), {output(2)}),
              "output out_0002.exr was not written by the recorded run");
}

class RunLockTest : public testing::Test {
protected:
    std::string pattern(const std::string& name = "out_####.exr") const { return (folder_ / name).string(); }
    /// Why the lock is not to be had; "" where it is.
    std::string refusal(const std::string& name, const std::vector<int>& frames) const {
        try {
            const RunLock lock(pattern(name), frames, "second");
            return "";
        } catch (const Error& error) {
            EXPECT_EQ(error.kind(), ErrorKind::output);
            return error.what();
        }
    }

    TemporaryFolder folder_;
};

TEST_F(RunLockTest, HoldsItsFramesOfItsOutputAndNothingElse) {
    const RunLock first(pattern(), {1, 2, 3, 7}, "first command");
    ASSERT_TRUE(first.is_held());
    for (const std::vector<int>& frames : {std::vector{3}, {-4, 7}, {2, 9}}) {
        const std::string why = refusal("out_####.exr", frames);
        EXPECT_NE(why.find("another run is writing frames"), std::string::npos) << why;
        EXPECT_NE(why.find("process " + std::to_string(getpid()) + " on host "), std::string::npos) << why;
        EXPECT_NE(why.find("frames 1-3,7: first command"), std::string::npos) << why;
    }
    EXPECT_NE(refusal("out_%d.exr", {1}), "") << "the same files by another pattern";
    EXPECT_EQ(refusal("out_####.exr", {4, 5, 6}), "");
    EXPECT_EQ(refusal("out_####.png", {1}), "");
    EXPECT_NE(refusal("out_####.exr", {1}), "") << "what others took and gave back is still held";
}

TEST_F(RunLockTest, IsGivenBackAndLeavesNothing) {
    { const RunLock first(pattern(), {1}, "first"); }
    EXPECT_EQ(refusal("out_####.exr", {1}), "");
    EXPECT_EQ(folder_.file_count(), 0u);
}

TEST_F(RunLockTest, OfAKilledProcessIsFree) {
    const pid_t child = fork();
    if (child == 0) {
        new RunLock(pattern(), {1, 2}, "killed");
        _exit(0);
    }
    int status = 0;
    ASSERT_EQ(waitpid(child, &status, 0), child);
    ASSERT_EQ(status, 0);
    ASSERT_FALSE(fs::is_empty(folder_ / ".aftershade")) << "the killed process could not clear up";
    { const RunLock next(pattern(), {1, 2}, "next"); }
    EXPECT_EQ(folder_.file_count(), 0u);
}

TEST_F(RunLockTest, WaitsForAWorkerWhoseRunWasKilled) {
    const pid_t run = fork();
    if (run == 0) {
        if (fork() == 0) {
            new RunLock(pattern(), {1, 2}, "/proc/self/exe run");
            write_text(folder_ / "held", "");
            while (getppid() != 1 && !fs::exists(folder_ / "killed")) usleep(1000);
            usleep(1'500'000);  // memory to free, on a busy machine
            _exit(0);
        }
        pause();
    }
    while (!fs::exists(folder_ / "held")) usleep(1000);
    EXPECT_NE(refusal("out_####.exr", {2}), "") << "its run goes on";
    kill(run, SIGKILL);
    write_text(folder_ / "killed", "");
    EXPECT_EQ(refusal("out_####.exr", {2}), "");
    waitpid(run, nullptr, 0);
}

TEST_F(RunLockTest, OfAnOutputWithoutANumberIsOneForAllFrames) {
    const RunLock first(pattern("out.exr"), {1}, "first");
    EXPECT_NE(refusal("out.exr", {2}), "");
}

}  // namespace
}  // namespace aftershade::test
