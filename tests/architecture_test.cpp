// The rules of STYLE.md that a compiler does not enforce.
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace {

namespace fs = std::filesystem;
const fs::path kRoot = AFTERSHADE_SOURCE_DIR;

/// The modules that each module may include, besides itself.
const std::map<std::string, std::set<std::string>> kAllowed = {
    {"plugin", {}},
    {"core", {}},
    {"image", {"core"}},
    {"compare", {"core", "image"}},
    {"gpu", {"core"}},
    {"graph", {"core", "gpu"}},
    {"effect", {"core", "image", "gpu", "graph", "plugin"}},
    {"pipeline", {"core", "image", "gpu", "graph", "effect", "plugin"}},
    {"batch", {"core", "image", "compare", "gpu", "graph", "effect", "pipeline"}},
    {"scene", {"core", "image"}},
};

struct Line {
    std::string place;
    std::string text;  // without its // comment
};

std::vector<Line> code_lines(const fs::path& folder, const std::set<std::string>& extensions) {
    std::vector<Line> lines;
    for (const auto& entry : fs::recursive_directory_iterator(folder)) {
        if (!entry.is_regular_file() || !extensions.contains(entry.path().extension().string())) continue;
        std::ifstream in(entry.path());
        int number = 0;
        for (std::string text; std::getline(in, text);) {
            ++number;
            const std::size_t comment = text.find("//");
            const std::string place =
                fs::relative(entry.path(), kRoot).string() + ":" + std::to_string(number);
            lines.push_back({place, text.substr(0, comment)});
        }
    }
    return lines;
}

TEST(Architecture, IncludesPointOneWay) {
    const std::regex include(R"re(^\s*#include "framework/(\w+)/.*)re");
    for (const auto& entry : fs::directory_iterator(kRoot / "framework")) {
        if (!entry.is_directory()) continue;
        const std::string module = entry.path().filename().string();
        ASSERT_TRUE(kAllowed.contains(module))
            << "say in this test what framework/" << module << " may include";
        for (const Line& line : code_lines(entry.path(), {".h", ".cpp"})) {
            EXPECT_FALSE(std::regex_search(line.text, std::regex(R"(#include "(cli|tests|effects)/)")))
                << line.place;
            std::smatch match;
            if (!std::regex_match(line.text, match, include) || match[1] == module) continue;
            EXPECT_TRUE(kAllowed.at(module).contains(match[1])) << line.place << ": " << line.text;
        }
    }
}

/// A unit is a header with its source; "x_internal.h" belongs to x.
std::string unit_of(const std::string& path) {
    const std::string unit = path.substr(0, path.rfind('.'));
    constexpr std::string_view kInternal = "_internal";
    return unit.ends_with(kInternal) ? unit.substr(0, unit.size() - kInternal.size()) : unit;
}

/// The units that each unit of a module includes.
std::map<std::string, std::set<std::string>> units_included(const std::string& module) {
    const std::regex include(R"re(^\s*#include "(framework/\w+/\w+\.h)".*)re");
    std::map<std::string, std::set<std::string>> included;
    for (const Line& line : code_lines(kRoot / "framework" / module, {".h", ".cpp"})) {
        std::smatch match;
        if (!std::regex_match(line.text, match, include)) continue;
        const std::string from = unit_of(line.place.substr(0, line.place.find(':'))), to = unit_of(match[1]);
        if (from != to) included[from].insert(to);
    }
    return included;
}

/// "a -> b -> a"; "" where no unit leads back to itself.
std::string circle_from(const std::string& start, const std::map<std::string, std::set<std::string>>& included) {
    std::vector<std::string> open{start};
    std::map<std::string, std::string> came_from;
    while (!open.empty()) {
        const std::string unit = open.back();
        open.pop_back();
        const auto found = included.find(unit);
        if (found == included.end()) continue;
        for (const std::string& next : found->second) {
            if (next == start) {
                std::string circle = unit + " -> " + start;
                for (std::string at = unit; at != start; circle = at + " -> " + circle) at = came_from.at(at);
                return circle;
            }
            if (came_from.emplace(next, unit).second) open.push_back(next);
        }
    }
    return "";
}

TEST(Architecture, NoTwoUnitsOfAModuleNeedEachOther) {
    for (const char* module : {"core", "image", "pipeline"}) {
        const auto included = units_included(module);
        EXPECT_FALSE(included.empty()) << module;
        for (const auto& [unit, others] : included) EXPECT_EQ(circle_from(unit, included), "");
    }
}

TEST(Architecture, OnlyTheGpuModuleCallsGl) {
    const std::regex gl(R"(\bgl[A-Z]\w*\s*\(|\begl[A-Z]\w*\s*\(|OSMesa[A-Z]|<glad/|\bGL_[A-Z]|\bEGL_[A-Z])");
    for (const char* folder : {"framework", "cli", "effects"})
        for (const Line& line : code_lines(kRoot / folder, {".h", ".cpp"})) {
            if (line.place.starts_with("framework/gpu/")) continue;
            EXPECT_FALSE(std::regex_search(line.text, gl)) << line.place << ": " << line.text;
        }
}

TEST(Architecture, NothingOutsideAnEffectsFolderNamesIt) {
    std::vector<std::string> ids;
    for (const auto& entry : fs::directory_iterator(kRoot / "effects"))
        if (entry.is_directory()) ids.push_back(entry.path().filename().string());
    ASSERT_FALSE(ids.empty());
    for (const char* folder : {"framework", "cli", "glsl"})
        for (const Line& line : code_lines(kRoot / folder, {".h", ".cpp", ".glsl", ".vert", ".json"}))
            for (const std::string& id : ids)
                EXPECT_FALSE(std::regex_search(line.text, std::regex("\\b" + id + "\\b")))
                    << line.place << ": " << line.text;
}

TEST(Architecture, TheGraphKnowsNoDocuments) {
    for (const Line& line : code_lines(kRoot / "framework/graph", {".h", ".cpp"}))
        EXPECT_EQ(line.text.find("framework/core/document.h"), std::string::npos) << line.place;
}

}  // namespace
