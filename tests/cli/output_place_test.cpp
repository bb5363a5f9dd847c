// Where outputs go: folders that are made, places that take nothing, and what is checked before the frames.
#include <unistd.h>

#include <regex>
#include <utility>

#include "framework/batch/process_codes.h"
#include "tests/cli/batch_work.h"
#include "tests/cli/small_disk.h"

namespace aftershade::test {
namespace {

namespace fs = std::filesystem;

/// What makes a run write one more kind of file, and that file.
struct Kind {
    std::vector<std::string> words;
    std::string file;
};

std::vector<Kind> kinds(const std::string& folder) {
    const auto in = [&](const std::string& name) { return folder + "/" + name; };
    return {{{"-o", in("out.exr")}, in("out.exr")},
            {{"-o", in("out.png")}, in("out.png")},
            {{"-o", "a.exr", "--telemetry", in("t.json")}, in("t.json")},
            {{"-o", "a.exr", "--telemetry-plot", in("t.svg")}, in("t.svg")},
            {{"-o", "a.exr", "--graph", in("g.dot")}, in("g.dot")},
            {{"-o", "a.exr", "--tap", "trail.kept=" + in("k.exr")}, in("k.exr")},
            {{"-o", "a.exr", "--history-out", in("h")}, in("h")}};
}

class OutputPlace : public BatchWork {
protected:
    OutputPlace() { write_frames(1, 1, 256, 144); }
    CommandResult run_kind(const Kind& kind, int exit_code) const {
        std::vector<std::string> arguments{"trail.json", "in_0001.exr"};
        arguments.insert(arguments.end(), kind.words.begin(), kind.words.end());
        return run(arguments, exit_code);
    }
    static bool names(const CommandResult& result, const std::string& file, const std::string& reason) {
        return std::regex_search(result.err, std::regex("aftershade: error: " + file + ": .*" + reason));
    }
};

TEST_F(OutputPlace, FoldersOfOutputsAreMade) {
    for (const Kind& kind : kinds("new/folder")) {
        run_kind(kind, 0);
        EXPECT_TRUE(fs::exists(folder_ / kind.file)) << kind.file;
        fs::remove_all(folder_ / "new");
    }
}

TEST_F(OutputPlace, AFaultInTheWordsMakesNoFolder) {
    run({"nothing.json", "in_0001.exr", "-o", "new/out.exr", "--scale", "3"}, int(ExitCode::usage));
    EXPECT_FALSE(fs::exists(folder_ / "new"));
}

TEST_F(OutputPlace, AFullDiskIsReportedAndKeepsTheOlderFile) {
    const SmallDisk disk(folder_ / "disk");
    if (!disk.mounted()) GTEST_SKIP() << "mounting a small file system needs root";
    for (const Kind& kind : kinds("disk")) write_text(folder_ / kind.file, "older");
    disk.fill();
    const auto before = contents(folder_ / "disk");
    for (const Kind& kind : kinds("disk")) {
        const CommandResult result = run_kind(kind, int(ExitCode::output));
        EXPECT_TRUE(names(result, kind.file, "No space left on device")) << result.err;
        EXPECT_EQ(contents(folder_ / "disk"), before) << kind.file;
    }
}

TEST_F(OutputPlace, AReadOnlyDiskIsToldBeforeTheFrames) {
    const SmallDisk disk(folder_ / "disk");
    if (!disk.mounted() || !disk.make_read_only()) GTEST_SKIP() << "mounting a file system needs root";
    for (const Kind& kind : kinds("disk")) {
        const CommandResult result = run_kind(kind, int(ExitCode::output));
        EXPECT_TRUE(names(result, kind.file, "Read-only file system")) << result.err;
        EXPECT_FALSE(fs::exists(folder_ / "a.exr")) << "frames were rendered for nothing";
    }
}

TEST_F(OutputPlace, AFolderWithoutPermissionIsReportedBeforeTheFrames) {
    fs::create_directory(folder_ / "theirs");
    fs::permissions(folder_ / "theirs", fs::perms::owner_read | fs::perms::owner_exec);
    std::vector<std::string> arguments =
        aftershade_words(words({"nothing.json", "in_0001.exr", "-o", "theirs/out.exr"}));
    if (geteuid() == 0) {  // whom permissions do not stop
        if (!fs::exists("/usr/bin/setpriv")) GTEST_SKIP() << "root needs setpriv to be somebody else";
        arguments.insert(arguments.begin(), {"/usr/bin/setpriv", "--reuid", "65534", "--clear-groups"});
        fs::permissions(folder_ / "theirs",
                        fs::perms::all & ~fs::perms::others_write & ~fs::perms::group_write);
    }
    const CommandResult result = Command(arguments, folder_.path()).wait();
    EXPECT_EQ(result.exit_code, int(ExitCode::output)) << result.err;
    EXPECT_TRUE(names(result, "theirs/out\\.exr", "Permission denied")) << result.err;
}

TEST_F(OutputPlace, StdoutThatTakesNothingIsToldAndTheFileIsWhole) {
    std::string script = "exec \"$0\" \"$@\" > /dev/full";
    std::vector<std::string> arguments{"/bin/sh", "-c", script};
    for (const std::string& word : aftershade_words(words({"nothing.json", "in_0001.exr", "-o", "out.exr"})))
        arguments.push_back(word);
    const CommandResult result = Command(arguments, folder_.path()).wait();
    EXPECT_EQ(result.exit_code, int(ExitCode::output)) << result.err;
    EXPECT_NE(result.err.find("standard output cannot be written: No space left on device"),
              std::string::npos)
        << result.err;
    EXPECT_NO_THROW(color("out.exr"));
    const CommandResult doctor =
        Command({"/bin/sh", "-c", script, AFTERSHADE_EXECUTABLE, "doctor", "--json"}, folder_.path()).wait();
    EXPECT_EQ(doctor.exit_code, int(ExitCode::output)) << "every verb that writes to stdout";
}

TEST_F(OutputPlace, APictureOfTheGraphIsRefusedBeforeTheFramesWithoutGraphviz) {
    fs::create_directory(folder_ / "empty");
    const CommandResult result = run({"nothing.json", "in_0001.exr", "-o", "out.exr", "--graph", "g.svg"},
                                     int(ExitCode::output), {{"PATH", (folder_ / "empty").string()}});
    EXPECT_NE(
        result.err.find("--graph g.svg: an .svg needs Graphviz's 'dot' (Debian package graphviz); write "
                        "a .dot instead"),
        std::string::npos)
        << result.err;
    EXPECT_FALSE(fs::exists(folder_ / "out.exr"));
}

TEST_F(OutputPlace, TheSummaryComesBeforeWhatMayFailAfterTheFrames) {
    fs::create_directory(folder_ / "tools");
    write_text(folder_ / "tools/dot", "#!/bin/sh\nexit 1\n");
    fs::permissions(folder_ / "tools/dot", fs::perms::owner_all);
    const CommandResult result = run({"nothing.json", "in_0001.exr", "-o", "out.exr", "--graph", "g.svg"},
                                     int(ExitCode::output), {{"PATH", (folder_ / "tools").string()}});
    EXPECT_NE(result.err.find("1 of 1 frames in "), std::string::npos) << result.err;
    EXPECT_TRUE(fs::exists(folder_ / "out.exr"));
    EXPECT_TRUE(temporaries().empty());
    for (const auto& [name, bytes] : contents(folder_.path()))
        EXPECT_FALSE(name.starts_with(".g.svg")) << name;
}

}  // namespace
}  // namespace aftershade::test
