// A standard output that takes nothing, for every verb that prints to it.
#include "tests/cli/batch_work.h"

namespace aftershade::test {
namespace {

using FullStdout = BatchWork;

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
        std::vector<std::string> shell{"/bin/sh", "-c", "exec \"$0\" \"$@\" > /dev/full"};
        for (const std::string& word : aftershade_words(arguments)) shell.push_back(word);
        const CommandResult result =
            Command(shell, folder_.path(), {{"AFTERSHADE_BACKEND", "software"}}).wait();
        EXPECT_EQ(result.exit_code, code) << arguments.front() << "\n" << result.err;
        EXPECT_NE(result.err.find("standard output cannot be written: No space left on device"),
                  std::string::npos)
            << arguments.front() << "\n"
            << result.err;
    }
}

}  // namespace
}  // namespace aftershade::test
