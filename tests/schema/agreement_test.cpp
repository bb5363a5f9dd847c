// The schemas against the program that they speak for: documents with every key that there is, changed
// in every place and every way, and judged by both.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

#include "framework/base/error.h"
#include "framework/capture/capture_grammar.h"
#include "framework/capture/profile.h"
#include "framework/capture/profile_grammar.h"
#include "framework/capture/sequence.h"
#include "framework/document/document.h"
#include "framework/document/schema_pieces.h"
#include "framework/effect/manifest/manifest_grammar.h"
#include "framework/effect/manifest/manifest_reader.h"
#include "framework/effect/registry.h"
#include "framework/golden/golden_suite.h"
#include "framework/look/look.h"
#include "framework/look/look_schema.h"
#include "framework/look/pipeline.h"
#include "framework/scattering/scattering_grammar.h"
#include "framework/scattering/scattering_profile.h"
#include "framework/scene/scene_reader.h"
#include "framework/scene/scene_schema.h"
#include "tests/documents.h"
#include "tests/temporary_folder.h"

namespace aftershade::test {
namespace {

namespace fs = std::filesystem;
using json = nlohmann::ordered_json;

const fs::path kFolder = fs::path(AFTERSHADE_SOURCE_DIR) / "tests/schema";

/// A document with one change.
struct Variant {
    std::string change;  ///< "/steps/0/enabled = null"
    json document;
};

/// What stands in place of a value: each kind of JSON, and what is near to a sound value of it.
std::vector<json> substitutes(const json& value) {
    std::vector<json> all = {
        nullptr,          true,          0, -1, 0.5, 1000000000, "", "x", "1 m", json::array(),
        json::array({0}), json::object()};
    if (value.is_number_integer())
        for (const int step : {-1, 1}) all.push_back(value.get<int>() + step);
    if (value.is_string()) {
        const std::string text = value;
        for (const std::string& near : {" " + text, text + " ", text + "-", "+" + text, text + ".1"})
            all.push_back(near);
    }
    if (value.is_array() && !value.empty()) {
        json shorter = value, longer = value;
        shorter.erase(shorter.size() - 1);
        longer.push_back(value.back());
        all.push_back(shorter);
        all.push_back(longer);
    }
    return all;
}

std::vector<Variant> variants_of(const json& document) {
    std::vector<Variant> variants;
    const auto add = [&](const std::string& change, const std::function<void(json&)>& make) {
        variants.push_back({change, document});
        make(variants.back().document);
    };
    std::vector<json::json_pointer> places{json::json_pointer()};
    for (std::size_t i = 0; i < places.size(); ++i) {
        const json::json_pointer place = places[i];
        const json& value = document.at(place);
        for (const json& other : substitutes(value))
            add(place.to_string() + " = " + other.dump(), [&](json& changed) { changed[place] = other; });
        if (value.is_object()) {
            add(place.to_string() + " + odd_key", [&](json& changed) { changed[place]["odd_key"] = 1; });
            for (const auto& [key, member] : value.items()) {
                add((place / key).to_string() + " gone", [&](json& changed) { changed[place].erase(key); });
                places.push_back(place / key);
            }
        } else if (value.is_array()) {
            for (std::size_t k = 0; k < value.size(); ++k) places.push_back(place / k);
        }
    }
    return variants;
}

/// "" for a document without faults, else the first.
using Judge = std::function<std::string(const std::string& text)>;

std::string first_fault(const Diagnostics& diagnostics) {
    for (const Diagnostic& diagnostic : diagnostics.all())
        if (diagnostic.severity == Severity::error) return diagnostic.message;
    return "";
}

std::string judge_look(const std::string& text) {
    static EffectRegistry effects({kFolder});
    Diagnostics diagnostics;
    const auto node = parse_document(text, (kFolder / "look.json").string(), diagnostics);
    if (const auto look = node ? parse_look(*node, diagnostics) : std::nullopt)
        bind_pipeline(*look, effects, {}, diagnostics);
    return first_fault(diagnostics);
}

std::string judge_capture(const std::string& text) {
    static const TemporaryFolder folder;
    write_text(folder / "capture.json", text);
    Diagnostics diagnostics;
    try {
        open_sequence((folder / "capture.json").string(), diagnostics);
    } catch (const Error& error) {
        // No such files: the document itself is sound.
        if (error.kind() != ErrorKind::capture) return error.what();
    }
    return first_fault(diagnostics);
}

std::string judge_manifest(const std::string& text) {
    Diagnostics diagnostics;
    const auto node = parse_document(text, "effect.json", diagnostics);
    if (node) parse_manifest(*node, kFolder / "every_form", diagnostics);
    return first_fault(diagnostics);
}

/// By a manifest that takes the module.
std::string judge_module(const std::string& text) {
    static const TemporaryFolder glsl;
    static const Node effect =
        parsed(R"({"aftershade": 1, "id": "every_form", "version": "1.0.0", "summary": ".",
        "modules": ["every_part"], "inputs": {"color": {"role": "color"}}, "outputs": {"color": {"role": "color"}},
        "passes": [{"name": "main", "shader": "main.frag", "reads": ["color"], "writes": ["color"]}]})");
    fs::create_directories(glsl / "every_part");
    write_text(glsl / "every_part/tone.frag", "");
    write_text(glsl / "every_part/module.json", text);
    Diagnostics diagnostics;
    parse_manifest(effect, kFolder / "every_form", diagnostics, glsl.path());
    return first_fault(diagnostics);
}

std::string judge_scene(const std::string& text) {
    Diagnostics diagnostics;
    const auto node = parse_document(text, (kFolder / "scene.json").string(), diagnostics);
    if (node) scene::parse_scene(*node, diagnostics);
    return first_fault(diagnostics);
}

std::string judge_producer(const std::string& text) {
    Diagnostics diagnostics;
    const auto node = parse_document(text, "profile.json", diagnostics);
    if (node) parse_profile(*node, diagnostics);
    return first_fault(diagnostics);
}

std::string judge_case(const std::string& text) {
    Diagnostics diagnostics;
    const auto node = parse_document(text, "effects/blur/cases/soft.json", diagnostics);
    if (node) parse_effect_case(*node, "effects/blur/cases/soft.json", "/root", diagnostics);
    return first_fault(diagnostics);
}

std::string judge_profile(const std::string& text) {
    static const TemporaryFolder folder;
    write_text(folder / "profile.json", text);
    Diagnostics diagnostics;
    parse_scattering_profile(parsed("\"profile.json\""), "profile", folder.path(), diagnostics);
    return first_fault(diagnostics);
}

std::string judge_golden(const std::string& text) {
    static const TemporaryFolder folder;
    write_text(folder / "look.json", R"({"aftershade": 1, "steps": []})");
    fs::create_directories(folder / "own/effects");
    write_text(folder / "golden.json", text);
    Diagnostics diagnostics;
    read_golden_suite((folder / "golden.json").string(), diagnostics);
    return first_fault(diagnostics);
}

class SchemaAgreement : public testing::Test {
protected:
    void SetUp() override {
        if (std::system("/usr/bin/python3 -W ignore -c 'import jsonschema; jsonschema.Draft202012Validator' "
                        "2>/dev/null") != 0)
            GTEST_SKIP() << "SKIPPED: /usr/bin/python3 has no jsonschema (python3-jsonschema)";
    }

    /// For each variant "" or the schema's fault.
    std::vector<std::string> judge_by_schema(const std::string& schema,
                                             const std::vector<Variant>& variants) {
        write_text(folder_ / "schema.json", schema);
        std::string lines;
        for (const Variant& variant : variants) lines += variant.document.dump() + "\n";
        write_text(folder_ / "documents", lines);
        const std::string command = "/usr/bin/python3 '" + (kFolder / "validate.py").string() + "' '" +
                                    (folder_ / "schema.json").string() + "' < '" +
                                    (folder_ / "documents").string() + "' > '" +
                                    (folder_ / "verdicts").string() + "'";
        EXPECT_EQ(std::system(command.c_str()), 0);
        std::vector<std::string> verdicts;
        std::istringstream in(read_text(folder_ / "verdicts"));
        for (std::string line; std::getline(in, line);) verdicts.push_back(line);
        EXPECT_EQ(verdicts.size(), variants.size());
        verdicts.resize(variants.size());
        return verdicts;
    }

    /// `only_the_program` are faults that no schema can find, as regular expressions over
    /// "<change>\n<fault>".
    void hold(const std::string& file, const std::string& schema, const Judge& judge,
              const std::vector<std::string>& only_the_program) {
        const json document = json::parse(read_text(kFolder / file), nullptr, true, true);
        std::vector<Variant> variants{{"unchanged", document}};
        for (Variant& variant : variants_of(document)) variants.push_back(std::move(variant));
        const std::vector<std::string> by_schema = judge_by_schema(schema, variants);
        ASSERT_EQ(by_schema[0], "") << file;
        ASSERT_EQ(judge(document.dump()), "") << file;
        const std::vector<std::regex> rules(only_the_program.begin(), only_the_program.end());
        int taken = 0, refused = 0, known_to_the_program_alone = 0;
        for (std::size_t i = 0; i < variants.size(); ++i) {
            const std::string by_program = judge(variants[i].document.dump());
            const std::string both = variants[i].change + "\n" + by_program;
            const auto fits = [&](const std::regex& rule) { return std::regex_search(both, rule); };
            if (by_program.empty()) {
                ++taken;
                EXPECT_EQ(by_schema[i], "")
                    << "the program takes what the schema refuses: " << variants[i].change;
            } else if (!by_schema[i].empty()) {
                ++refused;
            } else if (std::any_of(rules.begin(), rules.end(), fits)) {
                ++known_to_the_program_alone;
            } else {
                ADD_FAILURE() << "the schema takes what the program refuses: " << variants[i].change << "\n  "
                              << by_program;
            }
        }
        RecordProperty("taken", taken);
        RecordProperty("refused", refused);
        RecordProperty("known_to_the_program_alone", known_to_the_program_alone);
        std::printf("%s: %d changes taken by both, %d refused by both, %d that only the program can know\n",
                    file.c_str(), taken, refused, known_to_the_program_alone);
    }

    TemporaryFolder folder_;
};

TEST_F(SchemaAgreement, OfALookChangedEverywhere) {
    EffectRegistry effects({kFolder});
    Diagnostics diagnostics;
    const EffectManifest* effect = effects.find("every_form", diagnostics);
    ASSERT_EQ(lines_of(diagnostics), Lines{});
    hold("look.json", look_schema({effect}), judge_look,
         {
             "^/vars",               // what a variable's value must be depends on where it is used
             "has no variable '",    // names of what stands elsewhere in the document
             "no step '.*' before",  //
             "a second step named",  //
             "/in/[^]*(is not a role|has no output|takes the role)",
             "no file '",                          // what lies on the disk
             "\"1 m\"\n.* is above the maximum",   // numbers within strings
             "is taken already by",                // two values against each other
             "must lie above the x of the point",  //
             "weights of .* sum to",               //
             "no scattering profile '",            // what is shipped
         });
}

TEST_F(SchemaAgreement, OfACaptureChangedEverywhere) {
    hold("capture.json", capture_schema(), judge_capture, {});
}

TEST_F(SchemaAgreement, OfAProducersProfileChangedEverywhere) {
    hold("profile.json", profile_schema(), judge_producer, {});
}

TEST_F(SchemaAgreement, OfACaseOfAnEffectChangedEverywhere) {
    hold("case.json", effect_case_schema(), judge_case,
         {
             "'hard_(fail|warn)' must be at least",  // two values against each other
             "/steps",                               // as the schema of looks says
             "'outputs' must name a role",           // or 'taps' a texture
         });
}

TEST_F(SchemaAgreement, OfAManifestChangedEverywhere) {
    hold("every_form/effect.json", effect_schema(), judge_manifest,
         {
             "is not the name of its folder|no file '",  // what lies on the disk
             // Names of what stands elsewhere in the document, and what that is.
             "which is neither |which is not |is not a parameter|without an 'identity'|is not one of '|does "
             "not name an optional",
             "has no 'history'|has no 'repeat'|no pass (reads|writes|uses|runs) |before any pass has written|"
             "before anything has filled the rest",
             "is not a texture of|must end in a channel|has no '(tile|scale)'|must have a 'scale'",
             "has no key '|is not declared 'indirect'|another pass has this name",
             // One value against another, or their units.
             "is (above|below) |'min' of at least|must rise|has a unit, but|cannot be (compared|converted)",
             "each value needs one|must lie above|must go up|taken already|twice|differ in size|has not the "
             "size of|in one "
             "turn|but it has|holds|whole number",
             "words, more than|writes (no image|nothing)|outside the domain|is not a value of '|level",
             "'size': in \"",                      // formulas
             "no scattering profile '",            // what is shipped
             "^/presets/|^/params/skins/default",  // as the parameters and columns say
             // What a group may give to its entries, and what the variables of a 'for' are.
             "^/(inputs/around|textures/down_|passes/1[0-3]/passes)[^]*(has no |needs 'inst|be 'optional')",
             "names no variable|occurs twice|change together|of a number|for gone|\\((side|level) = ",
         });
}

TEST_F(SchemaAgreement, OfAModuleChangedEverywhere) {
    hold("every_part/module.json", module_schema(), judge_module,
         {
             "is not the name of its folder|no file '",  // what lies on the disk
             "which is neither |which is not |is not a parameter|is not one of '|declared already|GLSL name",
             "no pass (reads|writes|uses|runs) |before any pass has written it|before anything has filled "
             "the rest|"
             "another pass has this name",
             "is not a texture of|must end in a channel|has no 'tile'|must have a 'scale'",
             "is (above|below) |has a unit, but|must rise|holds|taken already|twice|whole number|words, more "
             "than",
             "writes (no image|nothing)|is not a value of '",
             "^/passes/2/passes[^]*(has no '|needs 'instances')",  // which a group may give
         });
}

TEST_F(SchemaAgreement, OfAScatteringProfileChangedEverywhere) {
    for (const char* file :
         {"burley.json", "burley_path.json", "gaussians.json", "dipole.json", "artist.json"})
        hold(std::string("profiles/") + file, scattering_profile_schema(), judge_profile,
             {"weights of .* sum to"});  // several values together
}

TEST_F(SchemaAgreement, OfASceneChangedEverywhere) {
    hold(
        "scene.json", scene::scene_schema(), judge_scene,
        {
            "there is no (material|mesh|earlier object) '",  // names of what stands elsewhere in the document
            "no scattering profile '",                       // what is shipped
            "^/meshes/quad/file ",                           // what lies on the disk
            "count: makes .* objects, more than",            // a product
            "are one point, which gives no direction",       // two values against each other
            "^/objects/8/material gone[^]*has no material",  // its mesh is no file that could give one
        });
}

TEST_F(SchemaAgreement, OfAGoldenSuiteChangedEverywhere) {
    hold("golden.json", golden_schema(), judge_golden,
         {
             "no file '|no folder '",                // what lies on the disk
             "a second case named",                  // names of what stands elsewhere in the document
             "'hard_(fail|warn)' must be at least",  // two values against each other
             "/steps",                               // as the schema of looks says
             "'outputs' must name a role",           // or 'taps' a texture
             "needs 'cases'",                        // or 'cases_of_effects'
             "'rectangle' has a width and a height of at least 1 px",  // of four numbers the last two
         });
}

}  // namespace
}  // namespace aftershade::test
