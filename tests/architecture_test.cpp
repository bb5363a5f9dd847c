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

/// The names in the table of framework/image/role.cpp.
std::vector<std::string> role_names() {
    std::ifstream in(kRoot / "framework/image/role.cpp");
    const std::string text{std::istreambuf_iterator<char>(in), {}};
    const std::regex row(R"re((?:rgb|xyz|xy)\("(\w+)",)re");
    std::vector<std::string> names = {"color", "depth", "object_id", "mask", "display"};
    for (std::sregex_iterator match(text.begin(), text.end(), row), end; match != end; ++match)
        names.push_back((*match)[1]);
    return names;
}

TEST(Architecture, RolesAreToldApartByTheirKindsNotTheirNames) {
    // Words of documents and options, and the renderer, which says what it computes for each role.
    const std::set<std::string> allowed = {"cli/run.cpp", "framework/compare/layer.cpp",
                                           "framework/image/role.cpp", "framework/pipeline/value_source.cpp",
                                           "framework/scene/capture_images.cpp"};
    std::string any;
    const std::vector<std::string> names = role_names();
    ASSERT_GE(names.size(), 13u);
    for (const std::string& name : names) any += (any.empty() ? "" : "|") + name;
    const std::string word = "\"(?:" + any + ")\"";
    const std::regex compared("[=!]= ?" + word + "|" + word + " ?[=!]=|starts_with\\(\"(?:" + any + "|aov:)|" + word +
                              ", *" + word);
    for (const char* folder : {"framework", "cli"})
        for (const Line& line : code_lines(kRoot / folder, {".h", ".cpp"}))
            if (!allowed.contains(line.place.substr(0, line.place.find(':'))))
                EXPECT_FALSE(std::regex_search(line.text, compared)) << line.place << ": " << line.text;
}

TEST(Architecture, TheGraphKnowsNoDocuments) {
    for (const Line& line : code_lines(kRoot / "framework/graph", {".h", ".cpp"}))
        EXPECT_EQ(line.text.find("framework/core/document.h"), std::string::npos) << line.place;
}

}  // namespace
