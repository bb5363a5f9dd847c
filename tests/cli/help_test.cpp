// What `--help` looks like, and what a word that names no command gets.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "tests/cli/command.h"

namespace aftershade::test {
namespace {

using Words = std::vector<std::string>;

CommandResult aftershade(Words words) {
    static const TemporaryFolder folder;
    words.insert(words.begin(), AFTERSHADE_EXECUTABLE);
    return Command(words, folder.path()).wait();
}

/// The commands that a help text lists.
Words commands_of(const std::string& help) {
    Words names;
    bool is_list = false;
    for (const std::string& line : lines_of_text(help)) {
        if (is_list && line.starts_with("  ") && line[2] != ' ')
            names.push_back(line.substr(2, line.find(' ', 2) - 2));
        if (!line.starts_with("  ")) is_list = line == "Subcommands:";
    }
    return names;
}

void expect_fits(const Words& command) {
    Words words = command;
    words.emplace_back("--help");
    const CommandResult help = aftershade(words);
    ASSERT_EQ(help.exit_code, 0) << help.err;
    const Words lines = lines_of_text(help.out);
    int groups = 0;
    for (const std::string& line : lines) {
        EXPECT_LE(line.size(), 100u) << line;
        if (!line.empty() && line[0] != ' ' && line.ends_with(':')) ++groups;
    }
    EXPECT_TRUE(lines.size() <= 60 || groups >= 4) << help.out;
    EXPECT_TRUE(std::ranges::any_of(lines,
                                    [](const std::string& line) {
                                        return line.starts_with("Exit codes: ") || line.starts_with("bash: ");
                                    }))
        << "the footer is whole\n"
        << help.out;
    for (const std::string& below : commands_of(help.out)) {
        words = command;
        words.push_back(below);
        expect_fits(words);
    }
}

TEST(Help, OfEveryCommandFitsAHundredColumnsAndAScreenOrGroups) {
    const Words commands = commands_of(aftershade({"--help"}).out);
    EXPECT_GE(commands.size(), 15u);
    expect_fits({});
}

TEST(Help, SaysWhatAnOptionTakesOnce) {
    const std::string help = aftershade({"compare", "--help"}).out;
    EXPECT_NE(help.find("(default: 0; 0 to 64; not with --forgive-blur)"), std::string::npos) << help;
    const std::string run = aftershade({"run", "--help"}).out;
    EXPECT_NE(run.find("Type of roles that are half by default (half or float)"), std::string::npos) << run;
    EXPECT_EQ(run.find("TEXT:"), std::string::npos) << run;
}

TEST(UnknownCommand, IsNamedWithTheOneThatWasMeant) {
    const CommandResult run = aftershade({"runn", "look.json", "in.exr"});
    EXPECT_EQ(run.exit_code, 2);
    EXPECT_EQ(run.err, "aftershade: error: 'runn' is not a command; did you mean 'run'?\n");
    const CommandResult golden = aftershade({"golden", "aprove", "suite"});
    EXPECT_EQ(golden.exit_code, 64);
    EXPECT_EQ(golden.err, "aftershade: error: 'aprove' is not a command; did you mean 'approve'?\n");
    EXPECT_EQ(
        aftershade({"golden", "xyzzyx"}).err,
        "aftershade: error: 'xyzzyx' is not a command; choose from run, approve, report, comment, init, "
        "explain, serve and apply-approvals\n");
}

}  // namespace
}  // namespace aftershade::test
