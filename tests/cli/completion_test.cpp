// Completion scripts in the shells themselves, and manual pages before man's own checkers.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "tests/cli/command.h"

namespace aftershade::test {
namespace {

namespace fs = std::filesystem;

const std::string kFolderOfProgram = fs::path(AFTERSHADE_EXECUTABLE).parent_path().string();

class Completion : public ::testing::Test {
protected:
    /// Writes the script of this shell, and returns its path.
    fs::path script_of(const std::string& shell) {
        const CommandResult printed = run({AFTERSHADE_EXECUTABLE, "completion", shell});
        EXPECT_EQ(printed.exit_code, 0) << printed.err;
        const fs::path file = folder_ / ("script." + shell);
        write_text(file, printed.out);
        return file;
    }

    CommandResult run(const std::vector<std::string>& words) {
        return Command(words, folder_.path(), {{"PATH", kFolderOfProgram + ":/usr/bin:/bin"}}).wait();
    }

    /// What bash offers for the last word.
    std::vector<std::string> bash_offers(const std::string& words) {
        const CommandResult result =
            run({"/bin/bash", "-c",
                 "source " + script_of("bash").string() + "; COMP_WORDS=(" + words +
                     "); COMP_CWORD=$((${#COMP_WORDS[@]} - 1)); _aftershade; "
                     "[ ${#COMPREPLY[@]} = 0 ] || printf '%s\\n' \"${COMPREPLY[@]}\""});
        EXPECT_EQ(result.exit_code, 0) << result.err;
        return lines_of_text(result.out);
    }

    TemporaryFolder folder_;
};

using Words = std::vector<std::string>;

TEST_F(Completion, OfBashOffersCommandsOptionsChoicesAndEffects) {
    EXPECT_EQ(bash_offers("aftershade ru"), Words{"run"});
    EXPECT_EQ(bash_offers("aftershade golden ''"),
              (Words{"run", "approve", "report", "comment", "init", "explain", "serve", "apply-approvals"}));
    EXPECT_EQ(bash_offers("aftershade run --frame-t"), Words{"--frame-timeout"});
    EXPECT_EQ(bash_offers("aftershade golden run --jun"), Words{"--junit"});
    EXPECT_EQ(bash_offers("aftershade run look.json --alpha ''"), (Words{"keep", "opaque"}));
    EXPECT_EQ(bash_offers("aftershade run --alpha = op"), Words{"opaque"});
    EXPECT_EQ(bash_offers("aftershade describe sss_b"), Words{"sss_burley"});
}

TEST_F(Completion, OfBashLeavesFilesToBash) {
    EXPECT_EQ(bash_offers("aftershade run lo"), Words{});
    EXPECT_EQ(bash_offers("aftershade run -o ''"), Words{});
}

TEST_F(Completion, OfBashHasEveryOptionThatHelpShows) {
    const std::vector<std::string> offers = bash_offers("aftershade run --");
    for (const std::string& line : lines_of_text(run({AFTERSHADE_EXECUTABLE, "run", "--help"}).out)) {
        const std::size_t at = line.find("--");
        if (!line.starts_with("  -") || at == std::string::npos) continue;
        const std::string name = line.substr(at, line.find_first_of(" ,", at) - at);
        EXPECT_NE(std::find(offers.begin(), offers.end(), name), offers.end()) << name;
    }
    EXPECT_GT(offers.size(), 50u);
}

TEST_F(Completion, OfFishOffersCommandsOptionsChoicesAndEffects) {
    if (!fs::exists("/usr/bin/fish")) GTEST_SKIP() << "fish is not installed";
    const std::string script = script_of("fish").string();
    const auto offers = [&](const std::string& line) {
        Words words;
        for (const std::string& offer : lines_of_text(
                 run({"/usr/bin/fish", "-N", "-c", "source " + script + "; complete -C '" + line + "'"}).out))
            words.push_back(offer.substr(0, offer.find('\t')));
        return words;
    };
    EXPECT_EQ(offers("aftershade ru"), Words{"run"});
    EXPECT_EQ(offers("aftershade golden "), (Words{"approve", "report", "run"}));
    EXPECT_EQ(offers("aftershade golden run --jun"), Words{"--junit"});
    EXPECT_EQ(offers("aftershade run --alpha "), (Words{"keep", "opaque"}));
    EXPECT_EQ(offers("aftershade describe sss_b"), Words{"sss_burley"});
}

TEST_F(Completion, OfZshIsSoundZsh) {
    if (!fs::exists("/usr/bin/zsh")) GTEST_SKIP() << "zsh is not installed";
    const CommandResult checked = run({"/usr/bin/zsh", "-f", "-n", script_of("zsh").string()});
    EXPECT_EQ(checked.exit_code, 0) << checked.err;
    // _arguments parses every row before it completes; outside of completion it reports only rows that it
    // refuses.
    const CommandResult defined =
        run({"/usr/bin/zsh", "-f", "-c",
             "autoload -Uz compinit; compinit -u -D; source " + script_of("zsh").string() +
                 "; print -rl ${(ok)functions[(I)_aftershade*]}"});
    const Words functions = lines_of_text(defined.out);
    for (const char* name :
         {"_aftershade", "_aftershade_run", "_aftershade_golden_approve", "_aftershade_effects"})
        EXPECT_NE(std::find(functions.begin(), functions.end(), name), functions.end())
            << name << defined.err;
}

TEST_F(Completion, NamesTheShellsThatItHas) {
    const CommandResult refused = run({AFTERSHADE_EXECUTABLE, "completion", "tcsh"});
    EXPECT_EQ(refused.exit_code, 2);
    EXPECT_NE(refused.err.find("bash,zsh,fish"), std::string::npos) << refused.err;
}

class ManPages : public Completion {};

TEST_F(ManPages, AreThereForEveryCommandAndSoundForMandoc) {
    const CommandResult made = run({AFTERSHADE_EXECUTABLE, "docs", "--man", "man1"});
    ASSERT_EQ(made.exit_code, 0) << made.err;
    for (const char* page : {"aftershade.1", "aftershade-run.1", "aftershade-golden-approve.1"})
        EXPECT_TRUE(fs::exists(folder_ / "man1" / page)) << page;
    const std::string run_page = read_text(folder_ / "man1/aftershade-run.1");
    EXPECT_NE(run_page.find("\\fB\\-\\-frames\\fR"), std::string::npos);
    EXPECT_NE(run_page.find("130 interrupted"), std::string::npos);
    if (!fs::exists("/usr/bin/mandoc")) GTEST_SKIP() << "mandoc is not installed";
    for (const auto& page : fs::directory_iterator(folder_ / "man1")) {
        const CommandResult checked = run({"/usr/bin/mandoc", "-Tlint", "-Wwarning", page.path().string()});
        for (const std::string& line : lines_of_text(checked.out))
            EXPECT_NE(line.find("missing date"), std::string::npos)
                << line;  // dates would change every build
    }
}

}  // namespace
}  // namespace aftershade::test
