// Every command of scripts/ says what it does, and every one that a page names is there.
#include <gtest/gtest.h>

#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <regex>
#include <set>
#include <sstream>
#include <string>

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

TEST(Scripts, PrintTheirUsageAndDoNothingElse) {
    int commands = 0;
    for (const auto& entry : fs::directory_iterator(kScriptsRoot / "scripts")) {
        if (!is_command(entry.path())) continue;
        ++commands;
        // A script that took no notice would build or install for minutes.
        const Told told = told_by("timeout 10 '" + entry.path().string() + "' --help");
        EXPECT_EQ(told.status, 0) << entry.path() << ": " << told.text;
        EXPECT_GT(told.text.size(), 60u) << entry.path() << ": " << told.text;
        EXPECT_EQ(told.text.find("Traceback"), std::string::npos) << entry.path();
        EXPECT_FALSE(told.text.starts_with("#")) << entry.path();
    }
    EXPECT_GT(commands, 40);
}

TEST(Scripts, AreThereWhereAPageNamesThem) {
    const std::regex named(R"(\bscripts/([a-z0-9-]+)(?![\w./-]))");
    std::set<fs::path> pages = {kScriptsRoot / "README.md", kScriptsRoot / "CONTRIBUTING.md",
                                kScriptsRoot / "SECURITY.md"};
    for (const auto& entry : fs::recursive_directory_iterator(kScriptsRoot / "docs"))
        if (entry.path().extension() == ".md") pages.insert(entry.path());
    int found = 0;
    for (const fs::path& page : pages) {
        std::ostringstream text;
        text << std::ifstream(page).rdbuf();
        const std::string words = text.str();
        for (std::sregex_iterator match(words.begin(), words.end(), named), end; match != end; ++match) {
            ++found;
            EXPECT_TRUE(fs::exists(kScriptsRoot / "scripts" / (*match)[1].str()))
                << page << " names scripts/" << (*match)[1];
        }
    }
    EXPECT_GT(found, 40);
}

}  // namespace
