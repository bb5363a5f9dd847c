// The rules of STYLE.md that a compiler does not enforce.
#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

#include "tests/temporary_folder.h"

namespace {

namespace fs = std::filesystem;
const fs::path kRoot = AFTERSHADE_SOURCE_DIR;

/// The modules that each module may include, besides itself.
const std::map<std::string, std::set<std::string>> kAllowed = {
    {"plugin", {}},
    {"base", {}},
    {"document", {"base"}},
    {"scattering", {"base", "document"}},
    {"image", {"base", "document"}},
    {"color", {"base", "document", "image"}},
    {"file", {"base", "document", "image"}},
    {"capture", {"base", "document", "image", "file"}},
    {"inspect", {"base", "document", "image", "file", "capture"}},
    {"compare", {"base", "document", "image", "file"}},
    {"gpu", {"base"}},
    {"graph", {"base", "gpu"}},
    {"effect", {"base", "document", "scattering", "image", "color", "file", "gpu", "graph", "plugin"}},
    {"look", {"base", "document", "image", "color", "file", "capture", "effect", "plugin"}},
    {"render", {"base", "document", "image", "file", "capture", "gpu", "graph", "effect", "plugin", "look"}},
    {"run",
     {"base", "document", "image", "file", "capture", "gpu", "graph", "effect", "plugin", "look", "render"}},
    {"batch",
     {"base", "document", "image", "file", "capture", "compare", "gpu", "graph", "effect", "look", "render",
      "run"}},
    {"golden",
     {"base", "document", "image", "file", "capture", "compare", "gpu", "graph", "effect", "look", "render",
      "run", "batch"}},
    {"host",
     {"base", "document", "image", "file", "capture", "inspect", "compare", "gpu", "graph", "effect", "look",
      "render", "run"}},
    {"serve",
     {"base", "document", "image", "file", "capture", "compare", "gpu", "graph", "effect", "look", "render",
      "run"}},
    {"review", {"base", "document", "golden", "compare", "serve"}},
    {"scene", {"base", "document", "scattering", "image", "file", "capture"}},
    {"visibility", {"base", "gpu", "graph", "image", "scene"}},
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
            std::size_t comment = text.find("//");
            while (comment != std::string::npos && comment > 0 && text[comment - 1] == ':')  // "https://"
                comment = text.find("//", comment + 2);
            const std::string place =
                fs::relative(entry.path(), kRoot).string() + ":" + std::to_string(number);
            lines.push_back({place, text.substr(0, comment)});
        }
    }
    return lines;
}

TEST(Architecture, IncludesPointOneWay) {
    const std::regex include(R"re(^\s*#\s*include\s*["<]framework/(\w+)/(.*)[">].*)re"),
        upwards(R"re(#\s*include\s*["<](cli/|tests/|effects/|\.))re");
    for (const auto& entry : fs::directory_iterator(kRoot / "framework")) {
        if (!entry.is_directory()) continue;
        const std::string module = entry.path().filename().string();
        ASSERT_TRUE(kAllowed.contains(module))
            << "say in this test what framework/" << module << " may include";
        for (const Line& line : code_lines(entry.path(), {".h", ".cpp"})) {
            EXPECT_FALSE(std::regex_search(line.text, upwards))
                << line.place
                << ": framework includes by paths from the root, and only itself: " << line.text;
            std::smatch match;
            if (!std::regex_match(line.text, match, include) || match[1] == module) continue;
            EXPECT_TRUE(kAllowed.at(module).contains(match[1]))
                << line.place << ": " << module << " may not include " << match[1]
                << " (docs/architecture.md, Modules); move the code, or change the table there and here";
            EXPECT_FALSE(match[2].str().ends_with("_internal.h"))
                << line.place << ": only " << match[1] << " may include its " << match[2];
        }
    }
}

TEST(Architecture, EveryModuleIsBuiltAndDescribed) {
    const std::string built = aftershade::test::read_text(kRoot / "framework/CMakeLists.txt"),
                      described = aftershade::test::read_text(kRoot / "docs/architecture.md");
    for (const auto& [module, allowed] : kAllowed) {
        EXPECT_TRUE(fs::is_directory(kRoot / "framework" / module))
            << "framework/" << module << " is gone: take it out of this test";
        EXPECT_NE(described.find("| `" + module + "` |"), std::string::npos)
            << "docs/architecture.md, Modules: add the row of " << module;
        if (module == "plugin") continue;  // a header alone
        EXPECT_NE(built.find("add_subdirectory(" + module + ")"), std::string::npos)
            << "framework/CMakeLists.txt: add_subdirectory(" << module << ")";
    }
}

/// STYLE.md says "near 400"; what is longer has two jobs.
TEST(Architecture, NoFileOfTheProgramIsFarAbove400Lines) {
    constexpr int kMostLines = 460;
    std::map<std::string, int> lengths;
    for (const char* folder : {"framework", "cli"})
        for (const Line& line : code_lines(kRoot / folder, {".h", ".cpp"}))
            ++lengths[line.place.substr(0, line.place.find(':'))];
    for (const auto& [file, lines] : lengths)
        EXPECT_LE(lines, kMostLines) << file << ": divide it by its jobs";
}

/// The other tests here look at no other endings.
TEST(Architecture, SourcesEndInHOrCpp) {
    const std::set<std::string> other = {".hpp", ".hh", ".hxx", ".cc", ".cxx", ".c", ".inl", ".inc", ".ipp"};
    for (const char* folder : {"framework", "cli"})
        for (const auto& entry : fs::recursive_directory_iterator(kRoot / folder))
            EXPECT_FALSE(other.contains(entry.path().extension().string()))
                << entry.path() << ": call it .h or .cpp";
}

/// A unit is a header with its source; "x_internal.h" belongs to x.
std::string unit_of(const std::string& path) {
    const std::string unit = path.substr(0, path.rfind('.'));
    constexpr std::string_view kInternal = "_internal";
    return unit.ends_with(kInternal) ? unit.substr(0, unit.size() - kInternal.size()) : unit;
}

/// The units that each unit of a module includes.
std::map<std::string, std::set<std::string>> units_included(const std::string& module) {
    const std::regex include(R"re(^\s*#include "(framework/[\w/]+\.h)".*)re");
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
std::string circle_from(const std::string& start,
                        const std::map<std::string, std::set<std::string>>& included) {
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

/// A folder's base names, but for headers that are installed under the API's own names.
std::map<std::string, std::set<std::string>> places_of_units() {
    std::map<std::string, std::set<std::string>> places;
    for (const char* folder : {"framework", "cli"})
        for (const auto& entry : fs::recursive_directory_iterator(kRoot / folder)) {
            const fs::path file = fs::relative(entry.path(), kRoot);
            const std::string ending = file.extension().string();
            if ((ending != ".h" && ending != ".cpp") || file.string().starts_with("framework/host/include"))
                continue;
            places[file.stem().string()].insert(file.parent_path().string());
        }
    return places;
}

TEST(Architecture, NoTwoUnitsHaveOneName) {
    for (const auto& [name, places] : places_of_units())
        EXPECT_EQ(places.size(), 1u) << name << ": " << *places.begin() << ", " << *places.rbegin()
                                     << "; give one of them a name of its own";
}

TEST(Architecture, NoTwoUnitsOfAModuleNeedEachOther) {
    for (const auto& [module, allowed] : kAllowed) {
        const auto included = units_included(module);
        for (const auto& [unit, others] : included)
            EXPECT_EQ(circle_from(unit, included), "") << "take what both need into a unit below them";
    }
}

TEST(Architecture, OnlyTheGpuModuleCallsGl) {
    const std::regex gl(
        R"(\bgl[A-Z]\w*\s*\(|\begl[A-Z]\w*\s*\(|OSMesa[A-Z]|<(?:glad|GL|GLES\w*|EGL)/|\bGL_[A-Z]|\bEGL_[A-Z])");
    for (const char* folder : {"framework", "cli", "effects"})
        for (const Line& line : code_lines(kRoot / folder, {".h", ".cpp"})) {
            if (line.place.starts_with("framework/gpu/")) continue;
            EXPECT_FALSE(std::regex_search(line.text, gl))
                << line.place << ": GL is called in framework/gpu alone: " << line.text;
        }
}

TEST(Architecture, NothingOutsideAnEffectsFolderNamesIt) {
    std::string ids;
    for (const auto& entry : fs::recursive_directory_iterator(kRoot / "effects"))
        if (fs::exists(entry.path() / "effect.json"))
            ids += (ids.empty() ? "" : "|") + entry.path().filename().string();
    ASSERT_FALSE(ids.empty());
    const std::regex any_id("\\b(" + ids + ")\\b");
    for (const char* folder : {"framework", "cli", "glsl"})
        for (const Line& line : code_lines(kRoot / folder, {".h", ".cpp", ".glsl", ".vert", ".json"}))
            EXPECT_FALSE(std::regex_search(line.text, any_id))
                << line.place
                << ": names an effect outside its folder; its manifest must say it: " << line.text;
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
    const std::set<std::string> allowed = {"cli/run_arguments.cpp", "framework/compare/layer.cpp",
                                           "framework/image/role.cpp", "framework/look/value_source.cpp",
                                           "framework/scene/capture_images.cpp"};
    std::string any;
    const std::vector<std::string> names = role_names();
    ASSERT_GE(names.size(), 13u);
    for (const std::string& name : names) any += (any.empty() ? "" : "|") + name;
    const std::string word = "\"(?:" + any + ")\"";
    const std::regex compared("[=!]= ?" + word + "|" + word + " ?[=!]=|starts_with\\(\"(?:" + any +
                              "|aov:)|" + word + ", *" + word);
    for (const char* folder : {"framework", "cli"})
        for (const Line& line : code_lines(kRoot / folder, {".h", ".cpp"})) {
            if (line.text.find('"') == std::string::npos) continue;  // quicker than the expression
            if (allowed.contains(line.place.substr(0, line.place.find(':')))) continue;
            EXPECT_FALSE(std::regex_search(line.text, compared))
                << line.place << ": test the role's RoleKind instead: " << line.text;
        }
}

TEST(Architecture, NoTextOfTheLibraryNamesAnOptionOfTheCommand) {
    const std::regex declared(R"re("(?:-\w,)?--([a-z][a-z-]*))re"), literal(R"re("(?:[^"\\]|\\.)*")re"),
        option("--([a-z][a-z-]*)");
    using Matches = std::sregex_iterator;
    std::set<std::string> own;
    for (const Line& line : code_lines(kRoot / "cli", {".cpp"}))
        for (Matches at(line.text.begin(), line.text.end(), declared); at != Matches(); ++at)
            own.insert((*at)[1]);
    ASSERT_GT(own.size(), 100u);
    for (const Line& line : code_lines(kRoot / "framework", {".h", ".cpp"})) {
        // Jobs of farms and of golden cases are command lines.
        if (line.place.starts_with("framework/batch/") || line.place.starts_with("framework/golden/") ||
            line.text.find("--") == std::string::npos)  // quicker than the expressions
            continue;
        for (Matches at(line.text.begin(), line.text.end(), literal); at != Matches(); ++at) {
            const std::string text = at->str();
            if (text.find("oiiotool") != std::string::npos) continue;
            for (Matches word(text.begin(), text.end(), option); word != Matches(); ++word)
                EXPECT_FALSE(own.contains((*word)[1]))
                    << line.place << ": say spelled(Option) of base/option.h instead of " << text;
        }
    }
}

TEST(Architecture, TheGraphKnowsNoDocuments) {
    for (const Line& line : code_lines(kRoot / "framework/graph", {".h", ".cpp"}))
        EXPECT_EQ(line.text.find("framework/document/document.h"), std::string::npos) << line.place;
}

/// Every text file of the repository, by its path from the root; what .gitignore names is left out.
std::map<std::string, std::string> text_files() {
    const std::set<std::string> ignored = {".git", "build", "__pycache__", "node_modules"};
    std::map<std::string, std::string> files;
    const fs::recursive_directory_iterator end;
    for (fs::recursive_directory_iterator entry(kRoot); entry != end; ++entry) {
        if (ignored.contains(entry->path().filename().string())) {
            entry.disable_recursion_pending();
            continue;
        }
        if (!entry->is_regular_file()) continue;
        std::ifstream in(entry->path(), std::ios::binary);
        std::string text{std::istreambuf_iterator<char>(in), {}};
        const bool is_text = std::string_view(text).substr(0, 8000).find('\0') == std::string_view::npos;
        if (is_text) files[fs::relative(entry->path(), kRoot).generic_string()] = std::move(text);
    }
    return files;
}

std::vector<std::string> lines_of(const std::string& text) {
    std::vector<std::string> lines;
    std::istringstream in(text);
    for (std::string line; std::getline(in, line);) lines.push_back(line);
    return lines;
}

/// What a heading is called in links, as GitHub and GitLab derive it.
std::string anchor_of(const std::string& heading) {
    std::string anchor;
    for (const char c : heading)
        if (c == ' ') anchor += '-';
        else if (std::isalnum(static_cast<unsigned char>(c)) || c == '-' || c == '_')
            anchor += char(std::tolower(static_cast<unsigned char>(c)));
    return anchor;
}

/// The lines of a page of Markdown that are no code.
std::vector<std::string> prose_of(const std::string& text) {
    std::vector<std::string> prose;
    bool is_code = false;
    for (const std::string& line : lines_of(text)) {
        if (line.starts_with("```")) is_code = !is_code;
        else if (!is_code) prose.push_back(line);
    }
    return prose;
}

bool has_heading(const std::string& text, const std::string& anchor) {
    for (const std::string& line : prose_of(text)) {
        const std::size_t level = line.find_first_not_of('#');
        if (level == 0 || level == std::string::npos || line[level] != ' ') continue;
        if (anchor_of(line.substr(level + 1)) == anchor) return true;
    }
    return false;
}

TEST(Architecture, NoLinePointsOutsideTheRepository) {
    // Where the large captures lie unless AFTERSHADE_CAPTURES says otherwise.
    const std::string beside =
        "../"
        "shared";
    const std::set<std::string> may_look_beside = {"scripts/checks/all", "scripts/checks/damaged",
                                                   "scripts/checks/distributions", "scripts/measure/tree.py",
                                                   "tests/real_captures.h"};
    // The page and the papers' numbers that the first authors worked from, and notes that only they had.
    const std::regex outside(
        "DESIGN"
        R"(\.md|\b[Ss]eed[ -]?0[0-9]|\breference/\w+\.md|captures/\w+/README)");
    std::set<std::string> looking_beside;
    for (const auto& [path, text] : text_files()) {
        int number = 0;
        for (const std::string& line : lines_of(text)) {
            const std::string place = path + ":" + std::to_string(++number);
            // The regex is slow on the long lines of pictures in SVG, which have no words of ours.
            if (line.size() < 10000) {
                EXPECT_FALSE(std::regex_search(line, outside)) << place << ": " << line;
            }
            if (line.find(beside) == std::string::npos) continue;
            EXPECT_TRUE(may_look_beside.contains(path)) << place << ": say $AFTERSHADE_CAPTURES instead";
            looking_beside.insert(path);
        }
    }
    EXPECT_EQ(looking_beside, may_look_beside);
}

TEST(Architecture, EveryLinkAndEveryPageThatIsNamedExists) {
    const auto files = text_files();
    const std::regex link(R"(\]\(([^()\s]+)\))"), page(R"(\bdocs/[\w/.-]+\.md\b)");
    const auto matches = [](const std::string& line, const std::regex& wanted, int group) {
        std::vector<std::string> found;
        for (std::sregex_iterator at(line.begin(), line.end(), wanted); at != std::sregex_iterator(); ++at)
            found.push_back((*at)[std::size_t(group)]);
        return found;
    };
    for (const auto& [path, text] : files) {
        if (path.ends_with(".svg")) continue;
        for (const std::string& line : lines_of(text))
            for (const std::string& named : matches(line, page, 0))
                EXPECT_TRUE(files.contains(named)) << path << " names " << named;
        if (!path.ends_with(".md")) continue;
        const fs::path folder = fs::path(path).parent_path();
        for (const std::string& line : prose_of(text))
            for (const std::string& target : matches(line, link, 1)) {
                if (target.find("://") != std::string::npos) continue;
                const std::size_t hash = std::min(target.find('#'), target.size());
                const std::string file =
                    hash == 0 ? path : (folder / target.substr(0, hash)).lexically_normal().generic_string();
                EXPECT_TRUE(fs::exists(kRoot / file)) << path << " links to " << target;
                if (hash == target.size() || !files.contains(file)) continue;
                EXPECT_TRUE(has_heading(files.at(file), target.substr(hash + 1)))
                    << path << " links to " << target;
            }
    }
}

}  // namespace
