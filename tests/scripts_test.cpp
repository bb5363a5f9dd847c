// Every command of scripts/ says what it does, and every one that a page names is there.
#include <gtest/gtest.h>

#include <unistd.h>
#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

namespace {

namespace fs = std::filesystem;

const fs::path kScriptsRoot = AFTERSHADE_SOURCE_DIR;

bool is_command(const fs::path& path) {
    return fs::is_regular_file(path) &&
           (fs::status(path).permissions() & fs::perms::owner_exec) != fs::perms::none;
}

struct Told {
    std::string text;  // of both streams
    int status = 0;
};

Told told_by(const std::string& command) {
    Told told;
    std::FILE* pipe = popen((command + " 2>&1 </dev/null").c_str(), "r");
    std::array<char, 4096> bytes{};
    for (std::size_t count = 0; (count = std::fread(bytes.data(), 1, bytes.size(), pipe)) > 0;)
        told.text.append(bytes.data(), count);
    told.status = pclose(pipe);
    return told;
}

std::vector<fs::path> commands_at_the_top() {
    std::vector<fs::path> commands;
    for (const auto& entry : fs::directory_iterator(kScriptsRoot / "scripts"))
        if (is_command(entry.path())) commands.push_back(entry.path());
    return commands;
}

/// By command, the names that it lists: those of lines "NAME   what it does" after the last blank line.
std::map<std::string, std::set<std::string>> sub_commands() {
    std::map<std::string, std::set<std::string>> found;
    for (const char* kind : {"bench", "check", "make", "quality"}) {
        const std::string listed =
            told_by("'" + (kScriptsRoot / "scripts" / kind).string() + "' --help").text;
        std::istringstream lines(listed.substr(listed.rfind("\n\n") + 2));
        for (std::string line; std::getline(lines, line);) found[kind].insert(line.substr(0, line.find(' ')));
    }
    return found;
}

void expect_usage(const std::string& command) {
    // A script that took no notice would build or install for minutes.
    const Told told = told_by("timeout 10 " + command + " --help");
    EXPECT_EQ(told.status, 0) << command << ": " << told.text;
    EXPECT_GT(told.text.size(), 60u) << command << ": " << told.text;
    EXPECT_EQ(told.text.find("Traceback"), std::string::npos) << command;
    EXPECT_FALSE(told.text.starts_with("#")) << command;
}

TEST(Scripts, AreAtMostTwelveCommands) {
    const std::size_t sourced = 1;  // setup.sh
    EXPECT_LE(commands_at_the_top().size() + sourced, 12u);
}

TEST(Scripts, PrintTheirUsageAndDoNothingElse) {
    for (const fs::path& command : commands_at_the_top()) expect_usage("'" + command.string() + "'");
    int count = 0;
    for (const auto& [kind, names] : sub_commands())
        for (const std::string& name : names) {
            ++count;
            expect_usage("'" + (kScriptsRoot / "scripts" / kind).string() + "' " + name);
        }
    EXPECT_GT(count, 40);
}

TEST(Scripts, RunThroughALinkFromAnotherFolder) {
    const fs::path link = fs::temp_directory_path() / ("aftershade-link-" + std::to_string(getpid()));
    fs::create_directory_symlink(kScriptsRoot, link);
    const Told told = told_by("cd / && '" + link.string() + "/scripts/check' docs --help");
    fs::remove(link);
    EXPECT_EQ(told.status, 0) << told.text;
    EXPECT_NE(told.text.find("usage: scripts/check docs"), std::string::npos) << told.text;
}

TEST(Scripts, AreThereWhereAPageNamesThem) {
    const std::regex named(R"(\bscripts/([a-z0-9-]+)(?![\w./-])(?: ([a-z0-9-]+))?)");
    std::set<fs::path> pages = {kScriptsRoot / "README.md", kScriptsRoot / "CONTRIBUTING.md",
                                kScriptsRoot / "SECURITY.md"};
    for (const auto& entry : fs::recursive_directory_iterator(kScriptsRoot / "docs"))
        if (entry.path().extension() == ".md") pages.insert(entry.path());
    int found = 0;
    const auto named_by = sub_commands();
    for (const fs::path& page : pages) {
        std::ostringstream text;
        text << std::ifstream(page).rdbuf();
        const std::string words = text.str();
        for (std::sregex_iterator match(words.begin(), words.end(), named), end; match != end; ++match) {
            ++found;
            const std::string command = (*match)[1], name = (*match)[2];
            EXPECT_TRUE(fs::exists(kScriptsRoot / "scripts" / command))
                << page << " names scripts/" << command;
            // A sentence may go on behind `scripts/bench`, which needs no name.
            if (named_by.contains(command) && command != "bench" && (*match)[2].matched) {
                EXPECT_TRUE(named_by.at(command).contains(name))
                    << page << " names scripts/" << command << ' ' << name;
            }
        }
    }
    EXPECT_GT(found, 40);
}

}  // namespace
