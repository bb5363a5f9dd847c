// docs/dependencies.md against what the scripts install, what CMake looks for, and what Debian 12 has.
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/temporary_folder.h"

namespace {

namespace fs = std::filesystem;
const fs::path kSources = AFTERSHADE_SOURCE_DIR;

struct Dependency {
    std::string version;
    std::string cmake;  // what CMake calls it; "" where it does not look
};

std::map<std::string, Dependency> listed() {
    std::map<std::string, Dependency> dependencies;
    const std::regex row(R"(\| ([\w.+-]+) \| (\S+) \| ([^|]+) \| (\w*) ?\| ([^|]+) \|)");
    std::istringstream lines(aftershade::test::read_text(kSources / "docs/dependencies.md"));
    for (std::string line; std::getline(lines, line);) {
        std::smatch match;
        if (!std::regex_match(line, match, row) || match[1] == "package") continue;
        EXPECT_TRUE(dependencies.emplace(match[1], Dependency{match[2], match[4]}).second) << line;
    }
    return dependencies;
}

std::set<std::string> all_matches(const std::string& text, const std::string& pattern) {
    const std::regex expression(pattern);
    std::set<std::string> found;
    for (std::sregex_iterator match(text.begin(), text.end(), expression), end; match != end; ++match)
        found.insert((*match)[1]);
    return found;
}

/// The words of NAME=( ... ) in a script, without its comments.
std::set<std::string> array_of(const std::string& script, const std::string& name) {
    const std::size_t begin = script.find(name + "=(");
    if (begin == std::string::npos) return {};
    const std::size_t open = begin + name.size() + 2;
    const std::string body =
        std::regex_replace(script.substr(open, script.find("\n)", open) - open), std::regex("#[^\n]*"), "");
    return all_matches(body.substr(0, body.find(')')), R"(([\w.+-]+))");
}

TEST(Dependencies, AreThoseThatTheScriptsInstall) {
    const std::string setup = aftershade::test::read_text(kSources / "scripts/setup.sh");
    std::set<std::string> installed = array_of(setup, "build_packages");
    installed.merge(array_of(setup, "gl_packages"));
    ASSERT_GE(installed.size(), 15u);
    const auto dependencies = listed();
    for (const std::string& package : installed)
        EXPECT_TRUE(dependencies.contains(package)) << package << " is not in docs/dependencies.md";
    std::string scripts;
    for (const auto& entry : fs::recursive_directory_iterator(kSources / "scripts"))
        if (entry.is_regular_file()) scripts += aftershade::test::read_text(entry.path());
    for (const auto& [package, dependency] : dependencies)
        EXPECT_TRUE(installed.contains(package) || scripts.find(package) != std::string::npos)
            << package << " is in docs/dependencies.md, and no script installs it";
}

TEST(Dependencies, AreThoseThatCMakeLooksFor) {
    std::string cmake = aftershade::test::read_text(kSources / "CMakeLists.txt");
    for (const char* folder : {"cmake", "framework", "cli", "effects", "python", "tests"})
        for (const auto& entry : fs::recursive_directory_iterator(kSources / folder))
            if (entry.path().filename() == "CMakeLists.txt" || entry.path().extension() == ".cmake")
                cmake += aftershade::test::read_text(entry.path());
    std::set<std::string> wanted = all_matches(cmake, R"(find_(?:package|path|program|library)\((\w+))");
    EXPECT_EQ(wanted.erase("Threads"), 1u) << "of the C library";
    std::set<std::string> named;
    for (const auto& [package, dependency] : listed())
        if (!dependency.cmake.empty()) named.insert(dependency.cmake);
    EXPECT_EQ(named, wanted);
}

TEST(Dependencies, HaveTheVersionsOfDebian12) {
    if (aftershade::test::read_text("/etc/os-release").find("VERSION_ID=\"12\"") == std::string::npos)
        GTEST_SKIP() << "this is not Debian 12";
    const std::regex package(R"(Package: (\S+))"), version(R"(Version: (?:\d+:)?(\S+))");
    std::map<std::string, std::string> installed;
    std::istringstream lines(aftershade::test::read_text("/var/lib/dpkg/status"));
    std::string name;
    for (std::string line; std::getline(lines, line);) {
        std::smatch match;
        if (std::regex_match(line, match, package)) name = match[1];
        else if (std::regex_match(line, match, version)) installed[name] = match[1];
    }
    for (const auto& [name_listed, dependency] : listed()) {
        const auto found = installed.find(name_listed);
        if (found == installed.end()) continue;
        EXPECT_NE(found->second.find(dependency.version), std::string::npos)
            << name_listed << " is " << found->second << ", docs/dependencies.md says " << dependency.version;
    }
}

}  // namespace
