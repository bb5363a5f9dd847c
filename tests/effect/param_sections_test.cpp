// Sections of parameters: declared in the manifest, shown by every description alike.
#include "framework/effect/description.h"

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "framework/effect/registry.h"
#include "tests/temporary_folder.h"

namespace aftershade::test {
namespace {

constexpr const char* kManifest =
    R"({ "aftershade": 1, "id": "sorted", "version": "1.0.0", "summary": "A test.",
  "inputs": { "color": { "role": "color", "doc": "c" } }, "outputs": { "color": { "role": "color", "doc": "c" } },
  "params": {
    "blades": { "type": "int", "default": 6, "section": "Aperture", "doc": "b" },
    "seed": { "type": "int", "default": 1, "advanced": true, "section": "Aperture", "doc": "s" },
    "strength": { "type": "float", "default": 1, "doc": "s" },
    "turn": { "type": "angle", "default": 0, "section": "Aperture", "doc": "t" } },
  "passes": [ { "name": "main", "shader": "main.frag", "reads": ["color"], "writes": ["color"] } ] })";

/// The places of words in a text, which must all be there.
std::vector<std::size_t> places(const std::string& text, const std::vector<std::string>& words) {
    std::vector<std::size_t> found;
    for (const std::string& word : words) {
        found.push_back(text.find(word));
        EXPECT_NE(found.back(), std::string::npos) << word << " is not in\n" << text;
    }
    return found;
}

TEST(ParamSections, StandInThePageAndInDescribePlainOnesFirstAndAdvancedOnesLast) {
    const TemporaryFolder folder;
    std::filesystem::create_directory(folder / "sorted");
    write_text(folder / "sorted/effect.json", kManifest);
    write_text(folder / "sorted/main.frag",
               "#version 450 core\n#include <pass>\nvoid main() { out_color = vec4(1); }\n");
    EffectRegistry effects({folder.path()});
    Diagnostics faults;
    const EffectManifest* manifest = effects.find("sorted", faults);
    ASSERT_TRUE(manifest && !faults.has_errors());
    EXPECT_TRUE(
        std::ranges::is_sorted(places(describe_markdown(*manifest), {"`strength`", "**Aperture**", "`blades`",
                                                                     "`turn`", "**Advanced**", "`seed`"})));
    EXPECT_TRUE(std::ranges::is_sorted(
        places(describe_text(*manifest, false),
               {"strength", "parameters: Aperture", "blades", "turn", "parameters: Advanced", "seed"})));
    const auto params = nlohmann::json::parse(describe_json(*manifest))["params"];
    EXPECT_EQ(params["blades"]["section"], "Aperture");
    EXPECT_EQ(params["seed"]["advanced"], true);
    EXPECT_FALSE(params["strength"].contains("section") || params["strength"].contains("advanced"));
}

}  // namespace
}  // namespace aftershade::test
