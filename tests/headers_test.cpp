// Headers include what they use. headers_alone (tests/CMakeLists.txt) compiles each by itself, but with the
// standard library's headers precompiled; this holds those to it.
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <regex>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace {

namespace fs = std::filesystem;
const fs::path kSourceRoot = AFTERSHADE_SOURCE_DIR;

struct Use {
    std::regex name;                ///< as the standard library spells it
    std::set<std::string> headers;  ///< any of them declares it
};

const std::vector<Use>& uses() {
    static const auto std_ = [](const std::string& names) { return std::regex("std::(?:" + names + ")\\b"); };
    static const std::vector<Use> all = {
        {std_("array"), {"array"}},
        {std_("atomic"), {"atomic"}},
        {std_("chrono"), {"chrono"}},
        {std_("clamp|find_if|find|sort|any_of|all_of|none_of|ranges"), {"algorithm"}},
        {std_("condition_variable"), {"condition_variable"}},
        {std_("deque"), {"deque"}},
        {std_("exception|exception_ptr"), {"exception", "stdexcept"}},
        {std_("filesystem"), {"filesystem"}},
        {std_("function"), {"functional"}},
        {std_("future|shared_future|promise|async"), {"future"}},
        {std_("initializer_list"), {"initializer_list"}},
        {std_("istream|ostream"), {"iosfwd", "istream", "ostream", "iostream", "sstream", "fstream"}},
        {std_("list"), {"list"}},
        {std_("map|multimap"), {"map"}},
        {std_("move|pair|exchange|swap|forward"), {"utility"}},
        {std_("mutex|lock_guard|unique_lock|once_flag"), {"mutex"}},
        {std_("numeric_limits"), {"limits"}},
        {std_("optional|nullopt"), {"optional"}},
        {std_("runtime_error|logic_error"), {"stdexcept"}},
        {std_("set|multiset"), {"set"}},
        {std_("span"), {"span"}},
        {std_("sqrt|abs|pow|sin|cos|tan|atan2|hypot|exp|log|floor|ceil|round|isfinite|isnan"),
         {"cmath", "cstdlib"}},
        {std_("string|to_string"), {"string"}},
        {std_("string_view"), {"string_view"}},
        {std_("thread|jthread"), {"thread"}},
        {std_("tuple|tie"), {"tuple"}},
        {std_("u?int(?:8|16|32|64)_t|uintmax_t|uintptr_t"), {"cstdint"}},
        {std_("unique_ptr|shared_ptr|weak_ptr|make_unique|make_shared"), {"memory"}},
        {std_("variant|visit|holds_alternative"), {"variant"}},
        {std_("vector"), {"vector"}},
    };
    return all;
}

struct Header {
    std::string code;  ///< without comments and includes
    std::set<std::string> included;
};

Header read_header(const fs::path& path) {
    const std::regex include(R"(^#include <([\w/]+)>)");
    Header header;
    std::ifstream in(path);
    for (std::string line; std::getline(in, line);) {
        std::smatch match;
        if (std::regex_search(line, match, include)) header.included.insert(match[1]);
        else header.code += line.substr(0, line.find("//")) + "\n";
    }
    return header;
}

TEST(Headers, IncludeTheStandardHeadersOfWhatTheyUse) {
    for (const char* folder : {"framework", "cli"})
        for (const auto& entry : fs::recursive_directory_iterator(kSourceRoot / folder)) {
            if (entry.path().extension() != ".h") continue;
            const Header header = read_header(entry.path());
            for (const Use& use : uses()) {
                std::smatch name;
                if (!std::regex_search(header.code, name, use.name)) continue;
                const auto is_included = [&](const std::string& one) {
                    return header.included.contains(one);
                };
                EXPECT_TRUE(std::ranges::any_of(use.headers, is_included))
                    << fs::relative(entry.path(), kSourceRoot).string() << " uses " << name.str()
                    << " without <" << *use.headers.begin() << ">";
            }
        }
}

}  // namespace
