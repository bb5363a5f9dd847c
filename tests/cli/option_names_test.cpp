// Every option that a message of the library may name is one that the command has.
#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>
#include <set>
#include <string>

#include <gtest/gtest.h>

#include "framework/base/option.h"
#include "tests/cli/command.h"

namespace aftershade::test {
namespace {

std::string word_of(std::string name) {
    std::ranges::replace(name, '_', '-');
    return "--" + name;
}

std::set<std::string> options_in(const std::string& text) {
    const std::regex option("--[a-z][a-z-]*");
    std::set<std::string> found;
    for (std::sregex_iterator at(text.begin(), text.end(), option); at != std::sregex_iterator(); ++at)
        found.insert(at->str());
    return found;
}

TEST(OptionsOfMessages, AreOptionsOfTheCommand) {
    using enum Option;
    const TemporaryFolder folder;
    const auto known = options_in(run_aftershade({"completion", "bash"}, folder.path()).out);
    for (const Option one : std::array{AFTERSHADE_OPTIONS})
        EXPECT_TRUE(known.contains(word_of(std::string(option_name(one))))) << option_name(one);
}

TEST(OptionsOfMessages, OnThePageAreOptionsOfServe) {
    const TemporaryFolder folder;
    const auto known = options_in(run_aftershade({"serve", "--help"}, folder.path()).out);
    const std::regex named("Option::(\\w+)");
    std::set<std::string> names;
    for (const auto& entry :
         std::filesystem::directory_iterator(std::string(AFTERSHADE_SOURCE_DIR) + "/framework/serve")) {
        std::ifstream in(entry.path());
        const std::string text{std::istreambuf_iterator<char>(in), {}};
        for (std::sregex_iterator at(text.begin(), text.end(), named); at != std::sregex_iterator(); ++at)
            names.insert((*at)[1]);
    }
    EXPECT_EQ(names.erase("truth"), 1u) << "of `aftershade render`, as the message says";
    EXPECT_EQ(names.erase("missing"), 1u) << "of `aftershade run`, as the copied command has it";
    EXPECT_GE(names.size(), 5u);
    for (const std::string& name : names) EXPECT_TRUE(known.contains(word_of(name))) << name;
}

}  // namespace
}  // namespace aftershade::test
