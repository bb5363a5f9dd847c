#include "framework/effect/registry.h"

#include "framework/effect/shader_source.h"
#include "tests/effect/effect_folder.h"

namespace aftershade {
namespace {

namespace fs = std::filesystem;
using test::Lines;

const fs::path kSourceFolder = AFTERSHADE_SOURCE_DIR;

void write_effect(const fs::path& folder, const std::string& id, const std::string& summary) {
    fs::create_directories(folder / id);
    test::write_text(
        folder / id / "effect.json",
        test::demo_manifest({{test::kHead, R"("aftershade": 1, "id": ")" + id +
                                               R"(", "version": "1.0.0", "summary": ")" + summary + "\""}}));
    for (const char* shader : {"a.frag", "b.frag"})
        test::write_text(folder / id / shader, "#version 450 core\n#include <pass>\n");
}

TEST(ShippedEffects, HaveNoFaults) {
    EffectRegistry effects({kSourceFolder / "effects"});
    EXPECT_GE(effects.ids().size(), 2U);
    for (const std::string& id : effects.ids()) {
        Diagnostics diagnostics;
        const EffectManifest* manifest = effects.find(id, diagnostics);
        EXPECT_EQ(test::lines_of(diagnostics), Lines{}) << id;
        ASSERT_NE(manifest, nullptr) << id;
        EXPECT_EQ(manifest->id, id);
        ParamSet defaults;
        for (const ParamSpec& spec : manifest->params) defaults.set(spec.name, spec.default_value);
        for (const PassSpec& pass : manifest->passes)
            if (pass.runs_shader())
                assemble_shader({manifest, &pass, defaults, {}, kSourceFolder / "glsl"}, diagnostics);
        EXPECT_EQ(test::lines_of(diagnostics), Lines{}) << id;
    }
}

TEST(Registry, ListsIdsSortedAndIgnoresOtherFolders) {
    const test::TemporaryFolder folder;
    for (const char* id : {"zoom", "blur", "tint"}) write_effect(folder.path(), id, ".");
    fs::create_directories(folder / "notes");
    test::write_text(folder / "effect.json", "{}");
    const EffectRegistry effects({folder.path(), folder / "not_there"});
    EXPECT_EQ(effects.ids(), (std::vector<std::string>{"blur", "tint", "zoom"}));
    EXPECT_TRUE(effects.contains("tint"));
    EXPECT_FALSE(effects.contains("notes"));
}

TEST(Registry, TakesAnEffectFromTheFirstFolderThatHasIt) {
    const test::TemporaryFolder first, second;
    write_effect(first.path(), "tint", "The user's.");
    write_effect(second.path(), "tint", "The shipped one.");
    write_effect(second.path(), "zoom", "The shipped one.");
    EffectRegistry effects({first.path(), second.path()});
    Diagnostics diagnostics;
    EXPECT_EQ(effects.find("tint", diagnostics)->summary, "The user's.");
    EXPECT_EQ(effects.find("zoom", diagnostics)->summary, "The shipped one.");
    EXPECT_FALSE(diagnostics.has_errors());
}

TEST(Registry, ReportsTheFaultsOfAManifestOnce) {
    const test::TemporaryFolder folder;
    write_effect(folder.path(), "tint", ".");
    fs::rename(folder / "tint", folder / "tnt");  // the id is no longer the folder's name
    EffectRegistry effects({folder.path()});
    Diagnostics diagnostics;
    EXPECT_EQ(effects.find("tnt", diagnostics), nullptr);
    const std::string file = (folder / "tnt/effect.json").string();
    EXPECT_EQ(test::lines_of(diagnostics),
              Lines{file + ":1:25: error: the id 'tint' is not the name of its folder, 'tnt'"});
    EXPECT_EQ(effects.find("tnt", diagnostics), nullptr);
    EXPECT_EQ(diagnostics.error_count(), 1);
    // Whoever asks later with diagnostics of their own, as a page after each edit, is answered too.
    Diagnostics later;
    EXPECT_EQ(effects.find("tnt", later), nullptr);
    EXPECT_EQ(test::lines_of(later), test::lines_of(diagnostics));
}

TEST(Registry, ReadsOnlyTheManifestsThatAreAskedFor) {
    const test::TemporaryFolder folder;
    write_effect(folder.path(), "tint", ".");
    fs::create_directories(folder / "broken");
    test::write_text(folder / "broken/effect.json", "{");
    EffectRegistry effects({folder.path()});
    Diagnostics diagnostics;
    const EffectManifest* tint = effects.find("tint", diagnostics);
    ASSERT_NE(tint, nullptr);
    EXPECT_EQ(effects.find("tint", diagnostics), tint) << "and once";
    EXPECT_FALSE(diagnostics.has_errors());
    EXPECT_EQ(effects.find("broken", diagnostics), nullptr);
    EXPECT_TRUE(diagnostics.has_errors());
}

TEST(Registry, KnowsNoOtherEffects) {
    EffectRegistry effects({kSourceFolder / "effects"});
    Diagnostics diagnostics;
    EXPECT_EQ(effects.find("no_such_effect", diagnostics), nullptr);
    EXPECT_FALSE(diagnostics.has_errors());
}

}  // namespace
}  // namespace aftershade
