// What verbs leave behind when they cannot end: nothing.
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>

#include "framework/base/atomic_file.h"
#include "framework/batch/process_codes.h"
#include "tests/cli/batch_work.h"

namespace aftershade::test {
namespace {

namespace fs = std::filesystem;

class Leftovers : public BatchWork {
protected:
    /// The words under a limit on the size of each file that the command writes, in blocks of 512 bytes.
    CommandResult with_file_limit(int blocks, const std::vector<std::string>& arguments) {
        // What it prints goes to files here, too.
        std::vector<std::string> shell{
            "/bin/sh", "-c", "ulimit -f " + std::to_string(blocks) + "; exec \"$0\" \"$@\" > /dev/null 2>&1"};
        for (const std::string& word : aftershade_words(arguments)) shell.push_back(word);
        return Command(shell, folder_.path()).wait();
    }
    /// The name that a process which is gone would have given to its temporary file.
    static fs::path stale_name(const fs::path& file) {
        const pid_t child = fork();
        if (child == 0) _exit(0);
        waitpid(child, nullptr, 0);
        std::string name = AtomicFile(file).temporary_path().string();
        const std::string own = "-" + std::to_string(getpid()) + "-";
        return name.replace(name.rfind(own), own.size(), "-" + std::to_string(child) + "-");
    }
};

TEST_F(Leftovers, OfANewEffectThatCannotBeWrittenAreNone) {
    const auto before = contents(folder_.path());
    EXPECT_EQ(with_file_limit(1, {"new", "mine"}).exit_code, int(ExitCode::output))
        << "the shader has more than 512 bytes";
    EXPECT_EQ(contents(folder_.path()), before);
    EXPECT_EQ(run_aftershade({"new", "mine"}, folder_.path()).exit_code, 0);
    EXPECT_EQ(contents(folder_.path()).size(), before.size() + 4) << "the folder and three files";
}

TEST_F(Leftovers, OfAGraphsPictureAreNone) {
    write_frames(1, 1, 16, 9);
    fs::create_directory(folder_ / "tools");
    // Graphviz writes what it can and says nothing of the rest.
    write_text(folder_ / "tools/dot",
               "#!/bin/sh\nfor word; do case $word in -o*) echo half > \"${word#-o}\"; esac; done\nexit 1\n");
    fs::permissions(folder_ / "tools/dot", fs::perms::owner_all);
    run({"nothing.json", "in_0001.exr", "-o", "out.exr", "--graph", "g.svg"}, int(ExitCode::output),
        {{"PATH", (folder_ / "tools").string() + ":" + std::getenv("PATH")}});
    for (const auto& [name, bytes] : contents(folder_.path()))
        EXPECT_FALSE(name.find("g.svg") != std::string::npos || name.ends_with(".tmp")) << name;
}

TEST_F(Leftovers, OfAKilledApprovalGoWithTheNext) {
    write_frames(1, 1, 16, 9);
    write_text(folder_ / "golden.json", R"({ "aftershade": 1, "cases": [
        { "name": "still", "steps": [], "capture": "in_0001.exr" } ] })");
    fs::create_directory(folder_ / "goldens");
    const fs::path stale = stale_name(folder_ / "goldens/still.color.0001.exr");
    write_text(stale, "half");
    const CommandResult result = run_aftershade({"golden", "approve", "golden.json"}, folder_.path());
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_FALSE(fs::exists(stale));
    EXPECT_EQ(contents(folder_ / "goldens").size(), 2u) << "the golden and its sidecar";
}

TEST_F(Leftovers, OfOutputsBehindALinkAreNoneAndTheLinkStays) {
    write_frames(1, 1, 16, 9);
    fs::create_directory(folder_ / "store");
    write_text(folder_ / "store/out.exr", "old");
    fs::permissions(folder_ / "store/out.exr", fs::perms::owner_read | fs::perms::owner_write);
    fs::create_symlink("store/out.exr", folder_ / "out.exr");
    run({"nothing.json", "in_0001.exr", "-o", "out.exr"}, 0);
    EXPECT_TRUE(fs::is_symlink(folder_ / "out.exr"));
    EXPECT_EQ(fs::status(folder_ / "store/out.exr").permissions(),
              fs::perms::owner_read | fs::perms::owner_write);
    EXPECT_EQ(color("store/out.exr").width(), 16);
    EXPECT_TRUE(temporaries().empty());
    ASSERT_EQ(mkfifo((folder_ / "pipe.exr").c_str(), 0600), 0);
    const CommandResult refused =
        run({"nothing.json", "in_0001.exr", "-o", "pipe.exr"}, int(ExitCode::output));
    EXPECT_NE(refused.err.find("pipe.exr: is a pipe, a socket or a device"), std::string::npos)
        << refused.err;
    EXPECT_TRUE(fs::is_fifo(folder_ / "pipe.exr"));
}

TEST_F(Leftovers, OfComparisonsGoToStandardOutputWhereThatIsNamed) {
    write_frames(1, 1, 16, 9);
    const CommandResult result = run_aftershade(
        {"compare", "in_0001.exr", "in_0001.exr", "--quiet", "--csv", "/dev/stdout"}, folder_.path());
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_TRUE(result.out.starts_with("reference,test,")) << result.out;
}

TEST_F(Leftovers, OfAnEffectFolderThatCannotBeReadAreTheOtherEffects) {
    write_frames(1, 1, 16, 9);
    fs::permissions(folder_ / "effects/poison", fs::perms::none);
    const auto as_nobody = [&](std::vector<std::string> arguments) {
        std::vector<std::string> all = aftershade_words(std::move(arguments));
        if (geteuid() == 0)  // whom permissions do not stop
            all.insert(all.begin(), {"/usr/bin/setpriv", "--reuid", "65534", "--clear-groups"});
        return Command(all, folder_.path()).wait();
    };
    if (geteuid() == 0 && !fs::exists("/usr/bin/setpriv")) GTEST_SKIP() << "root needs setpriv";
    const CommandResult list = as_nobody({"list", "--effect-path", "effects"});
    EXPECT_EQ(list.exit_code, 0) << list.err;
    EXPECT_NE(list.out.find("spread"), std::string::npos);
    EXPECT_NE(list.err.find("effects/poison: warning: cannot be read, and its effects are left out: "
                            "Permission denied"),
              std::string::npos)
        << list.err;
    const CommandResult needed = as_nobody({"check", "poison.json", "--no-gl", "--effect-path", "effects"});
    EXPECT_EQ(needed.exit_code, 1) << needed.err;
    EXPECT_NE(needed.err.find("no effect 'poison'"), std::string::npos) << needed.err;
    fs::permissions(folder_ / "effects/poison", fs::perms::owner_all);
}

}  // namespace
}  // namespace aftershade::test
