// A standard output that takes nothing, for every verb that prints to it.
#include "framework/batch/process_codes.h"
#include "tests/cli/batch_work.h"

namespace aftershade::test {
namespace {

class FullStdout : public BatchWork {
protected:
    CommandResult in_shell(const std::string& streams, const std::vector<std::string>& arguments,
                           const std::string& before = "") const {
        std::vector<std::string> shell{"/bin/sh", "-c", before + "exec \"$0\" \"$@\" " + streams};
        for (const std::string& word : aftershade_words(arguments)) shell.push_back(word);
        return Command(shell, folder_.path(), {{"AFTERSHADE_BACKEND", "software"}}).wait();
    }
};

TEST_F(FullStdout, IsAnOutputThatCannotBeWrittenForEveryVerb) {
    write_frames(1, 1);
    write_text(folder_ / "golden.json", R"({ "aftershade": 1, "cases": [
        { "name": "still", "steps": [], "capture": "in_0001.exr", "skip": "not now" } ] })");
    write_text(folder_ / "bloom.json", R"({ "aftershade": 1, "steps": [ { "effect": "bloom" } ] })");
    constexpr int kOutput = int(ExitCode::output), kFileError = 4;
    const std::vector<std::pair<std::vector<std::string>, int>> cases = {
        {{"--help"}, kOutput},
        {{"--version"}, kOutput},
        {{"schema"}, kOutput},
        {{"schema", "effect"}, kOutput},
        {{"list"}, kOutput},
        {{"list", "--json"}, kOutput},
        {{"list", "--scattering-profiles"}, kOutput},
        {{"describe", "bloom"}, kOutput},
        {{"describe", "bloom", "--json"}, kOutput},
        {{"describe", "skin"}, kOutput},
        {{"check", "nothing.json", "--no-gl"}, kOutput},
        {{"inspect", "in_0001.exr"}, kOutput},
        {{"inspect", "in_0001.exr", "--json"}, kOutput},
        {{"run", "nothing.json", "in_0001.exr", "-o", "out.exr"}, kOutput},
        {{"run", "bloom.json", "in_0001.exr", "-o", "out.exr", "--explain"}, kOutput},
        {{"new", "mine"}, kOutput},
        {{"doctor"}, kOutput},
        {{"compare", "in_0001.exr", "in_0001.exr"}, kFileError},
        {{"compare", "in_0001.exr", "in_0001.exr", "--json"}, kFileError},
        {{"golden", "run", "golden.json", "--json"}, kFileError},
    };
    for (const auto& [arguments, code] : cases) {
        for (const auto& [streams, why] :
             {std::pair("> /dev/full", "No space left on device"), std::pair(">&-", "Bad file descriptor")}) {
            std::filesystem::remove_all(folder_ / "mine");
            const CommandResult result = in_shell(streams, arguments);
            EXPECT_EQ(result.exit_code, code) << arguments.front() << streams << "\n" << result.err;
            EXPECT_NE(result.err.find(std::string("standard output cannot be written: ") + why),
                      std::string::npos)
                << arguments.front() << streams << "\n"
                << result.err;
        }
    }
}

TEST_F(FullStdout, IsNoneOfTheFilesThatARunOpensWhereStreamsAreClosed) {
    write_frames(1, 4);
    const std::vector<std::string> frames{"run", "nothing.json", "in_####.exr", "-o", "out/out_####.exr"};
    ASSERT_EQ(in_shell("", frames).exit_code, 0);
    const auto whole = contents(folder_ / "out");
    for (const char* jobs : {"1", "2"})
        for (const char* streams : {"<&-", "2>&-", "<&- 2>&-", "2> /dev/full", "<&- >&- 2>&-", ">&-"}) {
            std::filesystem::remove_all(folder_ / "out");
            std::vector<std::string> words = frames;
            if (*jobs == '2') words.insert(words.end(), {"--jobs", jobs});
            const bool says = std::string(streams).find(">&- ") == std::string::npos && *streams != '>';
            EXPECT_EQ(in_shell(streams, words).exit_code, says ? 0 : int(ExitCode::output))
                << streams << jobs;
            for (const auto& [name, bytes] : contents(folder_ / "out"))
                EXPECT_TRUE(!name.ends_with(".exr") || bytes == whole.at(name)) << name << streams << jobs;
        }
}

TEST_F(FullStdout, IsNotWhatFewOpenFilesSpoil) {
    write_frames(1, 4);
    for (const char* jobs : {"1", "2"})
        for (int files = 8; files <= 40; ++files) {
            std::vector<std::string> words{"run", "nothing.json",     "in_####.exr",
                                           "-o",  "out/out_####.exr", "--overwrite"};
            if (*jobs == '2') words.insert(words.end(), {"--jobs", jobs});
            const CommandResult result = in_shell("", words, "ulimit -n " + std::to_string(files) + "; ");
            if (result.exit_code == 0 || result.exit_code == 127) continue;  // 127: the loader has too few
            EXPECT_LT(result.exit_code, 8) << files << " files, " << jobs << " jobs: " << result.err;
            EXPECT_NE(result.err.find("Too many open files"), std::string::npos)
                << files << " files, " << jobs << " jobs: " << result.err;
        }
}

}  // namespace
}  // namespace aftershade::test
