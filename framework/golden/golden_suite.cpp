#include "framework/golden/golden_suite.h"

#include <fnmatch.h>

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>

#include "framework/base/data_path.h"
#include "framework/base/error.h"
#include "framework/base/path_bounds.h"
#include "framework/capture/frame_range.h"
#include "framework/capture/sequence.h"
#include "framework/document/grammar_reader.h"
#include "framework/document/grammar_schema.h"
#include "framework/effect/registry.h"
#include "framework/golden/approved_image.h"
#include "framework/golden/golden_grammar.h"

namespace aftershade {

namespace fs = std::filesystem;

namespace {

class SuiteReader {
public:
    SuiteReader(GoldenSuite& suite, Diagnostics& diagnostics) : suite_(suite), diagnostics_(diagnostics) {}

    void read(const Node& node) {
        grammar::check(node, golden_suite_block(), diagnostics_);
        const grammar::Reader reader(node, golden_suite_block());
        folder_ = suite_.file.parent_path();
        goldens_ = folder_ / reader.text("goldens");
        if (const std::string why = out_of_bounds(goldens_, folder_); !why.empty())
            diagnostics_.error(reader.place("goldens"), "the folder '" + goldens_.string() + "' " + why);
        suite_.golden_folders.push_back(goldens_);
        suite_.store = reader.text("store");
        for (const std::string& path : reader.texts("effect_paths")) add_effect_path(node, path);
        for (const grammar::Reader& test : reader.objects("cases")) add_case(test);
        if (reader.boolean("cases_of_effects")) add_cases_of_effects();
        if (suite_.cases.empty() && !diagnostics_.has_errors())
            diagnostics_.error(node.place, "a suite needs 'cases' or 'cases_of_effects'");
    }

private:
    void add_effect_path(const Node& node, const std::string& path) {
        suite_.effect_paths.push_back((folder_ / path).lexically_normal());
        if (!fs::is_directory(suite_.effect_paths.back()))
            diagnostics_.error(node.find("effect_paths")->place,
                               "no folder '" + suite_.effect_paths.back().string() + "'");
    }

    void add_case(const grammar::Reader& reader) {
        GoldenCase result;
        result.file = suite_.file;
        result.folder = folder_;
        result.goldens = goldens_;
        result.name = result.stem = reader.text("name");
        if (reader.has("name")) check_name(*reader.find("name"));
        if (reader.has("look")) {
            result.look = (folder_ / reader.text("look")).lexically_normal();
            if (!fs::is_regular_file(result.look))
                diagnostics_.error(reader.place("look"), "no file '" + result.look.string() + "'");
        }
        read_golden_case(reader, folder_, result, diagnostics_);
        suite_.cases.push_back(std::move(result));
    }

    void check_name(const Node& name) {
        const auto [other, is_new] = names_.emplace(name.string, name.place);
        if (!is_new)
            diagnostics_.error(name.place, "a second case named '" + name.string + "' (the first is at " +
                                               to_string(other->second) + ")");
    }

    void add_cases_of_effects() {
        std::vector<fs::path> folders = suite_.effect_paths;
        if (folders.empty()) folders.push_back(data_path() / "effects");
        for (const fs::path& folder : folders) {
            std::set<fs::path> effects;
            if (!fs::is_directory(folder)) continue;  // told of already
            for (const fs::path& room : rooms_of_effects(folder)) {
                if (!fs::is_directory(room)) continue;
                for (const auto& entry : fs::directory_iterator(room))
                    if (fs::is_regular_file(entry.path() / "effect.json")) effects.insert(entry.path());
            }
            for (const fs::path& effect : effects) suite_.golden_folders.push_back(effect / "cases");
            for (const fs::path& effect : effects)
                for (GoldenCase& test : read_effect_cases(effect, folder.parent_path(), diagnostics_))
                    suite_.cases.push_back(std::move(test));
        }
    }

    GoldenSuite& suite_;
    Diagnostics& diagnostics_;
    fs::path folder_, goldens_;
    std::map<std::string, Place> names_;
};

/// "lamps" of "lamps.color.0001@key.exr".
std::string first_word(const fs::path& file) {
    const std::string name = file.filename().string();
    return name.substr(0, name.find('.'));
}

/// A case's images; without frames those of its capture, whatever they are.
struct KnownImages {
    std::vector<std::string> stems;
    std::vector<int> frames;
    bool has(const std::string& name) const {
        return std::ranges::any_of(stems, [&](const std::string& stem) {
            const auto frame = approved_frame(name, stem);
            return frame && (frames.empty() || std::ranges::find(frames, *frame) != frames.end());
        });
    }
};

bool is_orphan(const fs::path& file, const std::map<std::string, KnownImages>& known) {
    const std::string name = file.filename().string();
    const bool image = file.extension() == ".exr", sidecar = file.extension() == ".json";
    // <case>.json is a case of an effect.
    if (name.starts_with('.') || (!image && !(sidecar && std::ranges::count(name, '.') > 1))) return false;
    const auto images = known.find(first_word(file));
    if (sidecar && !fs::exists(fs::path(file).replace_extension(".exr"))) {
        // An image of a store that could not be fetched is its case's verdict.
        std::string fault;
        return stored_digest(file.parent_path(), name, fault).empty() || images == known.end() ||
               !images->second.has(fs::path(name).replace_extension(".exr").string());
    }
    return images == known.end() || (image && !images->second.has(name));
}

/// --filter takes names and tags: a word that is both would approve more than the case that was looked at.
void check_tags(const GoldenSuite& suite, Diagnostics& diagnostics) {
    for (const GoldenCase& test : suite.cases)
        for (const GoldenCase& other : suite.cases)
            if (&other != &test && std::ranges::find(test.tags, other.name) != test.tags.end())
                diagnostics.error(
                    {test.file.string()},
                    fmt::format("case '{0}' has the tag '{1}', which is the name of a case; --filter {1} "
                                "would mean both: choose another tag",
                                test.name, other.name));
}

}  // namespace

std::optional<GoldenSuite> read_golden_suite(const std::string& argument, Diagnostics& diagnostics) {
    GoldenSuite suite;
    // In printed commands and sidecars: a path, whatever it begins with.
    suite.argument = (argument.starts_with('-') ? "./" : "") + argument;
    suite.file = fs::is_directory(argument) ? fs::path(argument) / "golden.json" : fs::path(argument);
    const auto node = read_document(suite.file, diagnostics);
    if (node) SuiteReader(suite, diagnostics).read(*node);
    check_tags(suite, diagnostics);
    if (diagnostics.has_errors()) return std::nullopt;
    suite.documents = diagnostics.documents();
    return suite;
}

bool fits_filter(const GoldenCase& test, const std::vector<std::string>& filters) {
    const auto fits = [&](const std::string& filter) {
        return fnmatch(filter.c_str(), test.name.c_str(), 0) == 0 ||
               std::ranges::find(test.tags, filter) != test.tags.end();
    };
    return filters.empty() || std::ranges::any_of(filters, fits);
}

std::string no_case_fits(const GoldenSuite& suite, const std::string& filter) {
    std::vector<std::string> words;
    for (const GoldenCase& test : suite.cases) {
        words.push_back(test.name);
        words.insert(words.end(), test.tags.begin(), test.tags.end());
    }
    return "matches no case's name or tag" + did_you_mean(filter, words);
}

std::vector<fs::path> orphaned_goldens(const GoldenSuite& suite, const std::vector<std::string>& filters) {
    std::map<fs::path, std::map<std::string, KnownImages>> known;  // by folder, by case
    std::set<std::pair<fs::path, std::string>> chosen;
    for (const GoldenCase& test : suite.cases) {
        known[test.goldens][test.stem] = {test.image_stems(),
                                          parse_frame_range(test.frames).value_or(std::vector<int>{})};
        if (fits_filter(test, filters)) chosen.insert({test.goldens, test.stem});
    }
    for (const fs::path& folder : suite.golden_folders) known[folder];
    std::vector<fs::path> orphans;
    for (const auto& [folder, images] : known) {
        if (!fs::is_directory(folder)) continue;
        for (const auto& entry : fs::directory_iterator(folder))
            if (entry.is_regular_file() && is_orphan(entry.path(), images) &&
                (filters.empty() || chosen.contains({folder, first_word(entry.path())})))
                orphans.push_back(entry.path());
    }
    std::sort(orphans.begin(), orphans.end());
    return orphans;
}

InputFiles suite_inputs(const GoldenSuite& suite, bool with_goldens) {
    InputFiles inputs;
    inputs.add(suite.documents);
    std::set<fs::path> goldens;
    for (const GoldenCase& test : suite.cases) {
        inputs.add(test.look);
        goldens.insert(test.goldens);
        const std::string capture = test.capture.string();
        if (const auto document = capture_document(capture)) inputs.add(*document);
        Diagnostics faults;
        try {
            if (const auto sequence = open_sequence(capture, faults))
                inputs.add(files_of_sequence(*sequence));
        } catch (const Error&) {
            // An absent or faulty capture is its case's verdict.
        }
        inputs.add(faults.documents());
    }
    std::error_code failure;
    if (with_goldens)
        for (const fs::path& folder : goldens)
            for (const auto& entry : fs::directory_iterator(folder, failure)) inputs.add(entry.path());
    return inputs;
}

std::string golden_schema() {
    return grammar::schema_text("Aftershade golden suite", golden_suite_block());
}

std::string effect_case_schema() {
    return grammar::schema_text("Aftershade case of an effect", effect_case_block());
}

}  // namespace aftershade
