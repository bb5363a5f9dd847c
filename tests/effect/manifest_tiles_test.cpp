// Tile lists: what they become, and what is wrong with the rest.
#include <algorithm>

#include "framework/effect/description.h"
#include "framework/effect/shader_source.h"
#include "framework/effect/usage_check.h"
#include "tests/effect/assembly.h"
#include "tests/effect/broken_manifests.h"

namespace aftershade {
namespace {

using test::demo_manifest;
using test::EffectFolder;
using test::has_line;
using test::Lines;
using test::Sections;

const std::filesystem::path kGlsl = std::filesystem::path(AFTERSHADE_SOURCE_DIR) / "glsl";

/// `target`: a texture that one of `passes` writes.
Sections tiled(const std::string& tiles, const std::string& passes, const std::string& target = "") {
    return {{test::kTextures, R"("textures": {
            "marks": {"format": "rg16f", "tile": 8, "when": {"flag": true}, "doc": "."},
            "whole": {"format": "rgba16f", "doc": "."},
            "half_size": {"format": "rgba16f", "scale": 0.5, "doc": "."})" +
                                  (target.empty() ? "" : ", " + target) + "}"},
            {test::kMore, "\"tiles\": {" + tiles + "}"},
            {test::kPasses, R"("passes": [
            {"name": "mark", "shader": "a.frag", "reads": ["color", "depth"], "writes": ["marks"]},
            {"name": "base", "shader": "a.frag", "writes": ["whole", "color"]},
            {"name": "small", "shader": "a.frag", "writes": ["half_size"]})" +
                                (passes.empty() ? "" : ", " + passes) + "]"}};
}

const std::string kMarked = R"("marked": {"of": "marks.g", "doc": "Where a mark is."})";
const std::string kNear =
    R"("near": {"predicate": "near.glsl", "tile": 16, "when": {"mode": "good"}, "doc": "."})";

TEST(TileLists, BecomeBuffersAndAPassBeforeTheFirstOverThem) {
    const EffectFolder folder(demo_manifest(tiled(kMarked, R"(
        {"name": "one", "shader": "b.frag", "reads": ["whole"], "writes": ["color"], "over": "marked", "when": {"taps": 3}},
        {"name": "two", "shader": "b.frag", "vertex": "d.vert", "reads": ["whole"], "writes": ["half_size"], "over": "marked"})")));
    const EffectManifest manifest = folder.sound_manifest();
    ASSERT_EQ(manifest.passes.size(), 6U);
    const PassSpec& list = manifest.passes[3];
    EXPECT_EQ(list.name, "marked");
    ASSERT_TRUE(list.compute());
    EXPECT_EQ(list.compute()->lists, "marked");
    ASSERT_EQ(list.reads.size(), 1U);
    EXPECT_EQ(list.reads[0].name, "marks");
    EXPECT_EQ(list.compute()->dispatch.over, "marks");
    EXPECT_EQ(list.compute()->dispatch.tile.number, 16);
    const BufferSpec* runs = manifest.find_buffer("marked_runs");
    ASSERT_NE(runs, nullptr);
    EXPECT_EQ(runs->element, "uvec4");
    EXPECT_EQ(runs->grid->tile.number, 8);
    const BufferSpec* args = manifest.find_buffer("marked_args");
    ASSERT_NE(args, nullptr);
    EXPECT_TRUE(args->indirect);
    EXPECT_EQ(args->clear, (std::vector<double>{4, 0, 0, 0}));
    for (const std::size_t i : {4U, 5U}) {
        const PassSpec& over = manifest.passes[i];
        EXPECT_EQ(over.draw()->instances->indirect, "marked_args") << over.name;
        EXPECT_EQ(over.buffers.at(0).name, "marked_runs") << over.name;
        EXPECT_EQ(over.when.back().subject, "flag")
            << "where the texture is absent, so is what depends on it";
    }
    EXPECT_EQ(manifest.passes[4].when.size(), 2U);
}

TEST(TileLists, AreListedByTheHostsShader) {
    const EffectFolder folder(demo_manifest(tiled(kMarked + ", " + kNear, R"(
        {"name": "one", "shader": "b.frag", "writes": ["color"], "over": "marked"},
        {"name": "two", "shader": "b.frag", "writes": ["half_size"], "over": "near"})")));
    folder.write("near.glsl", "bool near(ivec2 tile) { return texelFetch(whole, tile, 0).r > 1.0; }\n");
    const EffectManifest manifest = folder.sound_manifest();
    ASSERT_EQ(manifest.passes.size(), 7U);
    ParamSet params;
    for (const ParamSpec& spec : manifest.params) params.set(spec.name, spec.default_value);
    params.set("flag", true);
    const auto text = [&](std::size_t pass, ShaderFile file) {
        Diagnostics diagnostics;
        const ShaderSource source =
            assemble_shader({&manifest, &manifest.passes[pass], params, {}, kGlsl}, diagnostics, file);
        EXPECT_EQ(test::lines_of(diagnostics), Lines{});
        return source;
    };
    const ShaderSource of_texture = text(3, ShaderFile::main), by_predicate = text(5, ShaderFile::main),
                       over = text(4, ShaderFile::main);
    EXPECT_TRUE(
        has_line(of_texture, "bool is_listed(ivec2 tile) { return texelFetch(listed, tile, 0).g > 0.0; }"));
    EXPECT_TRUE(has_line(of_texture, "#define TILE_SIDE 8"));
    EXPECT_TRUE(has_line(by_predicate, "bool is_listed(ivec2 tile) { return near(tile); }"));
    EXPECT_TRUE(has_line(by_predicate, "#define TILE_SIDE 16"));
    EXPECT_EQ(manifest.passes[5].reads.at(0).name, "whole") << "the predicate's text names it";
    EXPECT_FALSE(has_line(over, "    vec4 tile_grid_size;")) << "the vertex shader that all share has it";
    EXPECT_EQ(manifest.passes[4].buffers.front().name, "marked_runs") << "where that shader reads it";
    const std::string described = describe_text(manifest, true);
    EXPECT_NE(described.find("tiles where marks.g > 0"), std::string::npos) << described;
    EXPECT_NE(described.find("tiles by near.glsl"), std::string::npos) << described;
    EXPECT_NE(described.find("-> half_size over near"), std::string::npos) << described;
}

TEST(TileLists, OfTexturesShareOneTextSoThatTheyShareAProgram) {
    const EffectFolder folder(demo_manifest(tiled(
        kMarked + R"(, "seen": {"of": "sights.g", "doc": "."}, "hidden": {"of": "sights.r", "doc": "."})",
        R"(
        {"name": "look", "shader": "a.frag", "writes": ["sights"]},
        {"name": "one", "shader": "b.frag", "writes": ["color"], "over": "marked"},
        {"name": "two", "shader": "b.frag", "writes": ["color"], "over": "seen"},
        {"name": "three", "shader": "b.frag", "writes": ["color"], "over": "hidden"})",
        R"("sights": {"format": "rg16f", "tile": 8, "doc": "."})")));
    const EffectManifest manifest = folder.sound_manifest();
    ParamSet params;
    for (const ParamSpec& spec : manifest.params) params.set(spec.name, spec.default_value);
    params.set("flag", true);
    const auto text = [&](const std::string& list) {
        const auto pass = std::ranges::find_if(
            manifest.passes, [&](const PassSpec& one) { return one.lists() && *one.lists() == list; });
        Diagnostics diagnostics;
        return assemble_shader({&manifest, &*pass, params, {}, kGlsl}, diagnostics, ShaderFile::main).text;
    };
    EXPECT_EQ(text("marked"), text("seen"));
    EXPECT_NE(text("seen"), text("hidden")) << "of another channel";
}

TEST(TileLists, SayWhatIsWrong) {
    const std::string over = R"({"name": "x", "shader": "b.frag", "writes": ["color"], "over": )";
    const auto expect = [&](const std::string& tiles, const std::string& pass, const Lines& messages) {
        test::expect_faults(tiled(tiles, pass), messages);
    };
    expect(kMarked, over + "\"market\"}",
           {"6: pass 'x': runs over 'market', which is not a tile list; did you mean 'marked'?",
            "8: no pass runs over the tile list 'marked'"});
    expect(R"("far": {"doc": "."})", over + "\"far\"}",
           {"8: tile list 'far' is 'of' a texture's channel or has a 'predicate', one of the two"});
    expect(R"("far": {"predicate": "", "tile": 8, "doc": "."})", over + "\"far\"}",
           {"8: 'predicate' is empty: it names a file"});
    expect("", over + "\"\"}", {"6: 'over' names no tile list"});
    expect(R"("far": {"of": "mark.r", "doc": "."})", over + "\"far\"}",
           {"8: tile list 'far', of: 'mark' is not a texture of the effect with one layer of floats; did you "
            "mean "
            "'marks'? (known: 'marks', 'whole' and 'half_size')"});
    expect(R"("far": {"of": "whole.r", "doc": "."})", over + "\"far\"}",
           {"8: tile list 'far', of: 'whole' has no 'tile': each of its texels must stand for one"});
    expect(R"("far": {"of": "marks.b", "doc": "."})", over + "\"far\"}",
           {"8: tile list 'far', of: 'marks.b' must end in a channel of 'marks', one of rg: \"marks.r\""});
    expect(R"("far": {"of": "marks.r", "tile": 8, "doc": "."})", over + "\"far\"}",
           {"8: tile list 'far' has no key 'tile' where it has 'of'"});
    expect(kMarked,
           R"({"name": "x", "shader": "b.frag", "vertex": "d.vert", "writes": ["color"], "over": "marked",
        "instances": {"of": "quads", "count": 1}})",
           {"6: a draw has 'instances' or is 'over' a list of tiles, not both"});
    expect(kMarked, R"({"name": "marked", "shader": "b.frag", "writes": ["color"], "over": "marked"})",
           {"6: pass 'marked': another pass has this name"});
}

/// The faults of a pass over kMarked, whose tiles have 8 px, that writes "target" with these keys.
Lines faults_of_target(const std::string& keys, const std::string& write = R"("target")",
                       const std::string& format = "rg16f") {
    const EffectFolder folder(demo_manifest(tiled(
        kMarked, R"({"name": "x", "shader": "b.frag", "over": "marked", "writes": [)" + write + "]}",
        R"("target": {"doc": ".", "format": ")" + format + "\"" + (keys.empty() ? "" : ", " + keys) + "}")));
    Diagnostics diagnostics;
    (void)folder.manifest(diagnostics);
    Lines texts;
    for (const Diagnostic& fault : diagnostics.all()) texts.push_back(fault.message);
    return texts;
}

TEST(TileLists, ConfineWhatTheirTilesAreMadeOf) {
    const std::string must = "pass 'x': runs over tiles, so what it writes, 'target', must ";
    EXPECT_EQ(faults_of_target(R"("tile": 4, "clear": 0)"), Lines{});
    EXPECT_EQ(
        faults_of_target(R"("tile": 12, "clear": 0)"),
        Lines{must + "have a 'scale' of the working grid, or a 'tile' that divides the list's of 8 px"});
    EXPECT_EQ(faults_of_target(R"("size": [8, 8], "clear": 0)"),
              Lines{must + "have a 'scale' of the working grid"});
    EXPECT_EQ(faults_of_target(R"("mips": 5, "clear": 0)", R"({"target": {"level": 3}})"), Lines{});
    EXPECT_EQ(faults_of_target(R"("mips": 5, "clear": 0)", R"({"target": {"level": 4}})"),
              Lines{must + "be of a level whose texels divide the list's tile of 8 px"});
}

TEST(TileLists, NeedSomethingAroundTheTiles) {
    const std::string fault =
        "pass 'x': draws over parts of 'target' before anything has filled the rest: "
        "copy an input to it (a pass of kind copy) or draw all of it in an earlier pass";
    EXPECT_EQ(faults_of_target(""), Lines{fault + ", or give it 'clear'"});
    EXPECT_EQ(faults_of_target(R"("clear": 0)"), Lines{});
    EXPECT_EQ(faults_of_target(R"("partial": true)", R"("target")", "r32ui"), Lines{});
    EXPECT_EQ(faults_of_target(R"("partial": false)", R"("target")", "r32ui"),
              Lines{fault + ", or give it 'clear'"});
}

TEST(TileLists, DoNotReadWhatTheyWriteInParts) {
    EXPECT_EQ(faults_of_target(R"("clear": 0)", R"("target"], "reads": ["target")"),
              Lines{"pass 'x': reads and writes 'target', but draws over parts of it alone: write another "
                    "texture, or name the pass's 'reads' without it (by default, each branch of an #if "
                    "counts)"});
    EXPECT_EQ(faults_of_target(R"("history": true, "clear": 0)", R"("target"], "reads": ["target.prev")"),
              Lines{});
}

TEST(TileLists, LieOnTexturesByTheirScale) {
    const auto faults = [](const std::string& on) {
        const EffectFolder folder(demo_manifest(
            tiled(R"("far": {"predicate": "far.glsl", "tile": 16, "on": ")" + on + R"(", "doc": "."})",
                  R"({"name": "x", "shader": "b.frag", "writes": ["color"], "over": "far"})")));
        folder.write("far.glsl", "bool far(ivec2 tile) { return true; }\n");
        Diagnostics diagnostics;
        const auto manifest = folder.manifest(diagnostics);
        if (manifest) {
            // 16 texels of half the size are 32 px.
            EXPECT_EQ(manifest->find_buffer("far_runs")->grid->tile.number, 32);
            EXPECT_EQ(manifest->passes[3].compute()->dispatch.over, on);
            EXPECT_EQ(manifest->passes[3].compute()->dispatch.tile.number, 256);
        }
        Lines texts;
        for (const Diagnostic& fault : diagnostics.all()) texts.push_back(fault.message);
        return texts;
    };
    EXPECT_EQ(faults("half_size"), Lines{});
    EXPECT_EQ(faults("marks"),
              Lines{"the tile list 'far' is on 'marks', which has no 'scale' of the working grid"});
    EXPECT_EQ(faults("half_sise"),
              Lines{"tile list 'far': dispatches over 'half_sise', which is not a texture; did "
                    "you mean 'half_size'?"});
}

TEST(TileLists, NeedTheFileThatDecides) {
    const EffectFolder folder(demo_manifest(
        tiled(kNear, R"({"name": "x", "shader": "b.frag", "writes": ["color"], "over": "near"})")));
    Diagnostics diagnostics;
    EXPECT_FALSE(folder.manifest(diagnostics).has_value());
    ASSERT_EQ(diagnostics.all().size(), 1U);
    EXPECT_EQ(diagnostics.all()[0].message,
              "tile list 'near': no file 'near.glsl' in " + folder.path().string());
    EXPECT_EQ(diagnostics.all()[0].place.file, (folder.path() / "effect.json").string());
}

TEST(TileLists, NeedTheFunctionThatDecides) {
    const EffectFolder folder(demo_manifest(
        tiled(kNear, R"({"name": "x", "shader": "b.frag", "writes": ["color"], "over": "near"})")));
    folder.write("near.glsl", "bool nearby(ivec2 tile) { return true; }\n");
    Diagnostics diagnostics;
    check_declared_used(folder.sound_manifest(), kGlsl, diagnostics);
    Lines told;
    for (const Diagnostic& fault : diagnostics.all())
        if (fault.message.starts_with("tile list")) told.push_back(fault.message);
    EXPECT_EQ(told,
              Lines{"tile list 'near': its predicate 'near.glsl' has no function 'bool near(ivec2 tile)'"});
}

}  // namespace
}  // namespace aftershade
