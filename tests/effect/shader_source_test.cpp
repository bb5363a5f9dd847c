#include "framework/effect/shader_source.h"

#include <algorithm>
#include <cstddef>

#include "tests/effect/assembly.h"
#include "tests/effect/block_bytes.h"

namespace aftershade {
namespace {

using test::Assembly;
using test::demo_manifest;
using test::EffectFolder;
using test::has_line;
using test::Lines;
using test::lines_of_text;
using test::value_at;

TEST(ShaderInterface, DeclaresWhatThePassSees) {
    const EffectFolder folder;
    Assembly assembly(folder);
    assembly.present = {"depth"};
    const Lines expected = {
        "#version 450 core",
        "#define HAS_DEPTH 1",
        "#define MODE_FAST 0",
        "#define MODE_GOOD 1",
        "#define MODE MODE_FAST",
        "layout(std140, binding = 0) uniform ParamBlock {",
        "    float gain;",
        "    bool flag;",
        "    int taps;",
        "} param;",
        "layout(std140, binding = 1) uniform FrameBlock {",
        "    ivec2 display_size;",
        "    ivec2 origin;",
        "    int number;",
        "    uint step_seed;",
        "    float fps;",
        "    bool history_valid;",
        "    mat3 rec709_from_color;",
        "    ivec2 size;",
        "    ivec2 full_display_size;",
        "    float scale;",
        "    int subframe;",
        "    int subframe_count;",
        "    float subframe_time;",
        "} frame;",
        "layout(std140, binding = 3) uniform CameraBlock {",
        "    mat4 view_from_world;",
        "    mat4 world_from_view;",
        "    mat4 clip_from_view;",
        "    mat4 view_from_clip;",
        "    mat4 clip_from_world;",
        "    mat4 world_from_clip;",
        "    mat4 prev_clip_from_world;",
        "    mat4 prev_view_from_world;",
        "    mat4 prev_clip_from_view;",
        "    mat4 prev_view_from_view;",
        "    vec3 position_m;",
        "    vec2 jitter_px;",
        "    vec2 prev_jitter_px;",
        "    float focal_length;",
        "    float sensor_width;",
        "    float focus_distance;",
        "    float f_number;",
        "    bool has_matrices;",
        "    bool has_prev_matrices;",
        "} camera;",
        "layout(binding = 0) uniform sampler2D color;",
        "layout(binding = 1) uniform sampler2D depth;",
        "layout(std140, binding = 2) uniform SizeBlock {",
        "    vec4 color_size;",
        "    vec4 depth_size;",
        "};",
        "layout(location = 0) out vec4 out_small;",
        "void main() {}",
    };
    EXPECT_EQ(lines_of_text(assembly.sound().text), expected);
}

TEST(ShaderTexts, AreReadOnceAndKeepTheirFaults) {
    const EffectFolder folder;
    folder.write("a.frag", "#version 450 core\n#include <pass>\n#include \"half.glsl\"\r\nlast");
    folder.write("half.glsl", "first\n\n");
    const EffectManifest manifest = folder.sound_manifest();
    ShaderTexts texts;
    const auto text_of_a = [&](Diagnostics& faults) {
        return author_text(manifest, manifest.passes[0], folder.path(), faults, ShaderFile::main, &texts)
            .text;
    };
    Diagnostics faults;
    EXPECT_EQ(text_of_a(faults), "#version 450 core\nfirst\n\nlast\n");
    folder.write("half.glsl", "second\n");
    EXPECT_EQ(text_of_a(faults), "#version 450 core\nfirst\n\nlast\n");
    EXPECT_EQ(test::lines_of(faults), Lines{});
    texts = {};
    EXPECT_EQ(text_of_a(faults), "#version 450 core\nsecond\nlast\n");

    // One that is not there is missed by each shader that includes it.
    texts = {};
    std::filesystem::remove(folder.path() / "half.glsl");
    for (int turn = 0; turn < 2; ++turn) {
        Diagnostics missed;
        text_of_a(missed);
        EXPECT_EQ(test::lines_of(missed),
                  Lines{(folder.path() / "a.frag").string() + ":3:1: error: cannot read " +
                        (folder.path() / "half.glsl").string()});
    }
}

TEST(ShaderInterface, LeavesOutAnOptionalInputThatIsAbsent) {
    const EffectFolder folder;
    const ShaderSource source = Assembly(folder).sound();
    EXPECT_EQ(source.text.find("HAS_DEPTH"), std::string::npos);
    EXPECT_EQ(source.text.find("sampler2D depth"), std::string::npos);
    EXPECT_EQ(source.text.find("depth_size"), std::string::npos);
    const EffectManifest manifest = folder.sound_manifest();
    EXPECT_EQ(present_reads(manifest, manifest.passes[0], ParamSet{}, {}).size(), 1U);
    EXPECT_EQ(present_reads(manifest, manifest.passes[0], ParamSet{}, {"depth"}).size(), 2U);
}

TEST(ShaderInterface, HasTypesForEveryFormat) {
    const std::vector<std::vector<std::string>> formats = {
        {"r8", "sampler2D", "float"},      {"rg16f", "sampler2D", "vec2"},
        {"rgba32f", "sampler2D", "vec4"},  {"r32ui", "usampler2D", "uint"},
        {"rg32ui", "usampler2D", "uvec2"}, {"rgba32ui", "usampler2D", "uvec4"},
        {"r32i", "isampler2D", "int"},
    };
    for (const auto& format : formats) {
        const EffectFolder folder(demo_manifest(
            {{test::kTextures, R"("textures": {"small": {"format": ")" + format[0] + R"(", "doc": "."}})"},
             {test::kPasses,
              R"("passes": [
            {"name": "one", "shader": "a.frag", "reads": ["color", "depth"], "writes": ["small"]},
            {"name": "two", "shader": "b.frag", "reads": ["color", "small"], "writes": ["color"]}])"}}));
        EXPECT_TRUE(
            has_line(Assembly(folder, 0).sound(), "layout(location = 0) out " + format[2] + " out_small;"));
        EXPECT_TRUE(
            has_line(Assembly(folder, 1).sound(), "layout(binding = 1) uniform " + format[1] + " small;"));
    }
}

TEST(ShaderInterface, GivesImagesTheFormatOfTheirRole) {
    EXPECT_EQ(texture_format_of_role("color"), gpu::TextureFormat::rgba32f);
    EXPECT_EQ(texture_format_of_role("albedo"), gpu::TextureFormat::rgba32f);  // three channels do not exist
    EXPECT_EQ(texture_format_of_role("velocity"), gpu::TextureFormat::rg32f);
    EXPECT_EQ(texture_format_of_role("depth"), gpu::TextureFormat::r32f);
    EXPECT_EQ(texture_format_of_role("object_id"), gpu::TextureFormat::r32ui);
}

TEST(ShaderInterface, WritesDefinesThatMeanTheirValueInGlsl) {
    const EffectFolder folder(demo_manifest({{test::kParams, R"("params": {
        "gain": {"type": "float", "unit": "m", "default": 3, "bind": "define", "doc": "."},
        "skew": {"type": "angle", "default": -30, "bind": "define", "doc": "."},
        "tiny": {"type": "float", "default": 1e-30, "bind": "define", "doc": "."},
        "taps": {"type": "int", "default": -4, "bind": "define", "doc": "."},
        "flag": {"type": "bool", "default": true, "bind": "define", "doc": "."},
        "tint": {"type": "color", "default": [1, 0.5, -2], "bind": "define", "doc": "."},
        "mode": {"type": "enum", "values": ["fast", "good"], "default": "good", "bind": "define", "doc": "."},
        "kind": {"type": "enum", "values": ["a", "b2"], "default": "b2", "doc": "."}})"}}));
    const Assembly assembly(folder);
    const ShaderSource source = assembly.sound();
    for (const char* line : {"#define GAIN 3.0", "#define SKEW (-30.0)", "#define TINY 1e-30",
                             "#define TAPS (-4)", "#define FLAG 1", "#define TINT vec3(1.0, 0.5, (-2.0))",
                             "#define MODE MODE_GOOD", "#define KIND_A 0", "#define KIND_B2 1"})
        EXPECT_TRUE(has_line(source, line)) << line << "\n" << source.text;
    EXPECT_FALSE(has_line(source, "#define KIND KIND_B2")) << "an enum that is a uniform is no define";
    EXPECT_TRUE(has_line(source, "    int kind;"));
}

TEST(ShaderInterface, HasThePassesOwnDefines) {
    const EffectFolder folder(demo_manifest({{test::kPasses, R"("passes": [
        {"name": "one", "shader": "a.frag", "reads": ["color", "depth"], "writes": ["small"],
         "defines": {"STEPS": 4}},
        {"name": "two", "shader": "b.frag", "reads": ["small"], "writes": ["color"]}])"}}));
    EXPECT_TRUE(has_line(Assembly(folder, 0).sound(), "#define STEPS 4"));
    EXPECT_FALSE(has_line(Assembly(folder, 1).sound(), "#define STEPS 4"));
}

TEST(ShaderSource, TakesEachFileOnce) {
    const EffectFolder folder;
    folder.write("a.frag",
                 "#version 450 core\n#include <pass>\n#include \"own.glsl\"\n#include "
                 "<shared.glsl>\n#include \"own.glsl\"\n"
                 "#include <pass>\nvoid main() {}\n");
    folder.write("own.glsl", "#include <shared.glsl> // for f\n#include <pass>\nfloat own;\n");
    const Assembly assembly(folder);
    test::write_text(assembly.glsl / "shared.glsl", "  #  include <shared.glsl>\r\nfloat shared;\r\n");
    const ShaderSource source = assembly.sound();
    const Lines lines = lines_of_text(source.text);
    for (const char* once : {"float own;", "float shared;", "} param;", "} frame;", "#define MODE MODE_FAST"})
        EXPECT_EQ(std::count(lines.begin(), lines.end(), once), 1) << once;
    EXPECT_LT(source.text.find("float shared;"), source.text.find("float own;"));
}

TEST(ShaderSource, MapsEveryLineBackToItsAuthors) {
    const EffectFolder folder;
    folder.write("a.frag",
                 "#version 450 core\n\n#include <pass>\n// one\n#include \"own.glsl\"\nvoid main() {\n}");
    folder.write("own.glsl", "// own 1\n#include <shared.glsl>\n// own 3\n\n// own 5\n");
    const Assembly assembly(folder);
    test::write_text(assembly.glsl / "shared.glsl", "// shared 1\n// shared 2\n");
    const ShaderSource source = assembly.sound();
    const Lines lines = lines_of_text(source.text);
    ASSERT_EQ(lines.size(), source.lines.size());

    Lines from_table;
    for (const SourceLine& line : source.lines) {
        if (line.file.text() == "<generated>") continue;
        from_table.push_back(std::filesystem::path(line.file.text()).filename().string() + ":" +
                             std::to_string(line.line));
    }
    EXPECT_EQ(from_table,
              (Lines{"a.frag:1", "a.frag:2", "a.frag:4", "own.glsl:1", "shared.glsl:1", "shared.glsl:2",
                     "own.glsl:3", "own.glsl:4", "own.glsl:5", "a.frag:6", "a.frag:7"}));
    for (std::size_t i = 0; i < lines.size(); ++i) {
        const SourceLine& line = source.lines[i];
        if (line.file.text() == "<generated>") continue;
        EXPECT_EQ(lines[i], lines_of_text(test::read_text(line.file.text())).at(std::size_t(line.line) - 1));
    }
}

TEST(ShaderSource, BeginsWithVersionAndPass) {
    const Lines begins = {
        "a.frag:1:1: error: a shader begins with '#version 450 core' and then has '#include <pass>'"};
    const EffectFolder folder;
    folder.write("a.frag", "#include <pass>\nvoid main() {}\n");
    EXPECT_EQ(Assembly(folder).faults(), begins);
    folder.write("a.frag", "#version 450 core\nvoid main() {}\n");
    EXPECT_EQ(Assembly(folder).faults(), begins);
    folder.write("a.frag", "");
    EXPECT_EQ(Assembly(folder).faults(), begins);

    const std::string once = "error: '#version 450 core' must appear once, as the first line of a shader";
    folder.write("a.frag", "// mine\n#version 450 core\n#include <pass>\n");
    EXPECT_EQ(Assembly(folder).faults(), (Lines{"a.frag:2:1: " + once, begins[0]}));
    folder.write("a.frag", "#version 330\n#include <pass>\n");
    EXPECT_EQ(Assembly(folder).faults(), (Lines{"a.frag:1:1: " + once, begins[0]}));
    folder.write("a.frag", "#version 450 core\n#include <pass>\n#include \"own.glsl\"\n");
    folder.write("own.glsl", "float f;\n#version 450 core\n");
    EXPECT_EQ(Assembly(folder).faults(), Lines{"own.glsl:2:1: " + once});
}

TEST(ShaderSource, IncludesOnlyPlainNamesOfItsOwnFolderAndTheShared) {
    const EffectFolder folder;
    folder.write("../secret.glsl", "float secret;\n");
    folder.write(".hidden.glsl", "float hidden;\n");
    for (const std::string name : {"../secret.glsl", "./own.glsl", "/etc/passwd", "sub/../own.glsl",
                                   "a/b/own.glsl", "sub/.hidden.glsl", "sub/", ".hidden.glsl", "..", ""}) {
        folder.write("a.frag", "#version 450 core\n#include <pass>\n#include \"" + name + "\"\n");
        EXPECT_EQ(Assembly(folder).faults(),
                  Lines{"a.frag:3:1: error: '" + name + "' is not a plain file name"});
        folder.write("a.frag", "#version 450 core\n#include <pass>\n#include <" + name + ">\n");
        EXPECT_EQ(Assembly(folder).faults(),
                  Lines{"a.frag:3:1: error: '" + name + "' is not a plain file name"});
    }
    folder.write("a.frag", "#version 450 core\n#include <pass>\n#include \"sub/own.glsl\"\n");
    EXPECT_EQ(Assembly(folder).faults(), Lines{"a.frag:3:1: error: 'sub/own.glsl' is not a plain file name"});
    // What the effect's own folder has is not found among the shared modules.
    folder.write("own.glsl", "float own;\n");
    folder.write("a.frag", "#version 450 core\n#include <pass>\n#include <own.glsl>\n");
    const Assembly assembly(folder);
    EXPECT_EQ(assembly.faults(),
              Lines{"a.frag:3:1: error: cannot read " + (assembly.glsl / "own.glsl").string()});
}

TEST(ShaderSource, TakesAFileOfAModuleAndWhatLiesBesideThatFile) {
    const EffectFolder folder;
    folder.write("a.frag",
                 "#version 450 core\n#include <pass>\n#include <lens/x.glsl>\n#include \"own.glsl\"\n");
    folder.write("own.glsl", "float effects_own;\n#include <lens/x.glsl>\n");
    const Assembly assembly(folder);
    std::filesystem::create_directories(assembly.glsl / "lens");
    test::write_text(assembly.glsl / "lens/x.glsl", "#include \"own.glsl\"\nfloat x;\n");
    test::write_text(assembly.glsl / "lens/own.glsl", "float lens_own;\n");
    const std::string text = assembly.sound().text;
    EXPECT_TRUE(text.ends_with("float lens_own;\nfloat x;\nfloat effects_own;\n")) << text;
}

TEST(ShaderSource, ListsAllMissingIncludes) {
    const EffectFolder folder;
    folder.write("a.frag",
                 "#version 450 core\n#include <pass>\n#include \"no.glsl\"\n\n#include \"none.glsl\"\n");
    const std::string path = folder.path().string();
    EXPECT_EQ(Assembly(folder).faults(), (Lines{"a.frag:3:1: error: cannot read " + path + "/no.glsl",
                                                "a.frag:5:1: error: cannot read " + path + "/none.glsl"}));
}

TEST(PassEnabled, WhenEveryConditionHolds) {
    const EffectFolder folder(demo_manifest({{test::kPasses, R"("passes": [
        {"name": "one", "shader": "a.frag", "reads": ["color", "depth"], "writes": ["small"],
         "when": {"mode": ["fast", "good"], "taps": [3, 5], "has.depth": true}},
        {"name": "two", "shader": "b.frag", "reads": ["small"], "writes": ["color"]}])"}}));
    Assembly assembly(folder);
    const PassSpec& pass = assembly.manifest.passes[0];
    EXPECT_TRUE(pass_enabled(pass, assembly.params, {"depth"}));
    EXPECT_FALSE(pass_enabled(pass, assembly.params, {}));
    assembly.params.set("taps", std::int64_t(4));
    EXPECT_FALSE(pass_enabled(pass, assembly.params, {"depth"}));
    assembly.params.set("taps", std::int64_t(5));
    EXPECT_TRUE(pass_enabled(pass, assembly.params, {"depth"}));
    EXPECT_TRUE(pass_enabled(assembly.manifest.passes[1], assembly.params, {}));
}

// Offsets by hand from OpenGL 4.5, section 7.6.2.2: scalars align to 4 bytes, vec2 to 8, vec3 and vec4 to 16,
// and a scalar may fill the fourth place of a vec3.
TEST(ParamBlock, LiesAsStd140Says) {
    const EffectFolder folder(demo_manifest({{test::kPresets, R"("presets": {})"},
                                             {test::kPasses, R"("passes": [{"name": "one", "shader": "a.frag",
        "reads": ["color", "depth"], "writes": ["color"]}])"},
                                             {test::kTextures, R"("textures": {})"},
                                             {test::kParams, R"("params": {
        "a": {"type": "float", "default": 1.5, "doc": "."},
        "b": {"type": "vec2", "default": [2, 3], "doc": "."},
        "skipped": {"type": "int", "default": 99, "bind": "define", "doc": "."},
        "c": {"type": "vec3", "default": [4, 5, 6], "doc": "."},
        "d": {"type": "int", "default": -7, "doc": "."},
        "e": {"type": "bool", "default": true, "doc": "."},
        "f": {"type": "vec4", "default": [8, 9, 10, 11], "doc": "."},
        "g": {"type": "float", "unit": "mm", "default": "1.2 cm", "doc": "."},
        "h": {"type": "color", "default": [13, 14, 15], "doc": "."},
        "i": {"type": "angle", "default": "0.25 turn", "doc": "."},
        "j": {"type": "enum", "values": ["x", "y", "z"], "default": "z", "doc": "."}})"}}));
    const Assembly assembly(folder);
    ASSERT_TRUE(has_param_block(assembly.manifest));
    const std::vector<std::byte> block = param_block(assembly.manifest, assembly.params);
    ASSERT_EQ(block.size(), 112U);  // 100, rounded up to 16
    EXPECT_EQ(value_at<float>(block, 0), 1.5f);
    EXPECT_EQ(value_at<float>(block, 8), 2.0f);
    EXPECT_EQ(value_at<float>(block, 12), 3.0f);
    for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(value_at<float>(block, 16 + 4 * i), float(4 + i));
    EXPECT_EQ(value_at<std::int32_t>(block, 28), -7);
    EXPECT_EQ(value_at<std::int32_t>(block, 32), 1);
    for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(value_at<float>(block, 48 + 4 * i), float(8 + i));
    EXPECT_EQ(value_at<float>(block, 64), 12.0f);  // mm, the declared unit
    for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(value_at<float>(block, 80 + 4 * i), float(13 + i));
    EXPECT_EQ(value_at<float>(block, 92), 90.0f);  // degrees
    EXPECT_EQ(value_at<std::int32_t>(block, 96), 2);
}

TEST(ParamBlock, IsAbsentWithoutUniforms) {
    const EffectFolder folder(demo_manifest({{test::kParams, R"("params": {
        "gain": {"type": "float", "unit": "m", "default": 1, "bind": "define", "doc": "."},
        "mode": {"type": "enum", "values": ["fast", "good"], "default": "good", "bind": "define",
                 "doc": "."}})"}}));
    const Assembly assembly(folder);
    EXPECT_FALSE(has_param_block(assembly.manifest));
    EXPECT_TRUE(param_block(assembly.manifest, assembly.params).empty());
    EXPECT_EQ(assembly.sound().text.find("ParamBlock"), std::string::npos);
}

}  // namespace
}  // namespace aftershade
