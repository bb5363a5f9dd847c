// Inputs, textures, buffers, native values: what they may say, and what is wrong with the rest.
#include "tests/effect/broken_manifests.h"

namespace aftershade {
namespace {

using test::demo_manifest;
using test::EffectFolder;
using test::kInputs;
using test::kMore;
using test::kParams;
using test::kPasses;
using test::kTextures;
using test::Lines;

const std::string kAllInputs = R"("inputs": {
    "color": {"role": "color", "history": true, "doc": "c"},
    "depth": {"role": "depth", "optional": true, "from": "capture"},
    "after": {"role": "color", "optional": true, "frame": 1}, "before": {"role": "color", "optional": true, "frame": -1}})";

TEST(ManifestResources, KeepsAllThatTheySay) {
    const EffectFolder folder(demo_manifest(
        {{kInputs, kAllInputs},
         {kParams, R"("params": {"gain": {"type": "float", "unit": "m", "default": 1, "doc": "."},
            "mode": {"type": "enum", "values": ["fast", "good"], "default": "fast", "doc": "."},
            "tile": {"type": "int", "default": 20, "min": 4, "max": 64, "doc": "."}})"},
         {kTextures, R"("textures": {
            "small": {"format": "rgba16f", "tile": "tile", "doc": "d"},
            "pyramid": {"format": "r16f", "mips": "auto", "clear": 0.5, "history": true, "doc": "."},
            "steps": {"format": "r32ui", "size": [256, 16], "mips": 5, "layers": 7, "clear": [1, 2, 3, 4], "doc": "."},
            "parts": {"format": "r32ui", "partial": true, "doc": "."}})"},
         {kMore, R"("buffers": {
            "list": {"element": "uvec2", "per": {"tile": "tile"}, "count": 3, "history": true, "doc": "b"},
            "args": {"element": "uint", "count": 4, "indirect": true, "clear": [4, 0, 0, 0], "doc": "."},
            "sums": {"element": "vec4", "count": "tile", "clear": 0, "doc": "."}},
            "native": {"uniforms": {"warp": {"type": "vec3", "doc": "w"}},
             "tables": {"kernel": {"element": "vec2", "count": 64, "doc": "k"},
                        "image": {"element": "uvec4", "count": [512, 1024], "doc": "."}}},
            "accumulates": "subframes")"},
         {kPasses, R"("passes": [
            {"name": "one", "shader": "a.frag", "reads": ["color", "color.prev", "depth", "after", "before", "pyramid.prev"],
             "buffers": {"list": "write", "list.prev": "read", "args": "atomic", "sums": "read"},
             "writes": ["small"]},
            {"name": "two", "shader": "a.frag", "writes": ["pyramid", "color"]},
            {"name": "wipe", "kind": "clear", "writes": ["steps"], "value": 9},
            {"name": "part", "shader": "a.frag", "writes": ["parts"]}])"}}));
    const EffectManifest manifest = folder.sound_manifest();
    ASSERT_EQ(manifest.inputs.size(), 4U);
    EXPECT_TRUE(manifest.find_input("color")->history);
    EXPECT_TRUE(manifest.find_input("depth")->from_capture);
    EXPECT_FALSE(manifest.find_input("color")->from_capture);
    EXPECT_EQ(manifest.find_input("after")->frame, 1);
    EXPECT_EQ(manifest.find_input("before")->frame, -1);
    EXPECT_TRUE(manifest.accumulates_subframes);
    EXPECT_TRUE(manifest.has_history());

    ASSERT_EQ(manifest.textures.size(), 4U);
    const GridSpec& small = manifest.textures[0].grid;
    EXPECT_EQ(small.kind, GridSpec::Kind::tile);
    EXPECT_EQ(small.tile, (CountSpec{1, "tile"}));
    EXPECT_EQ(manifest.most_of(small.tile), 64);
    EXPECT_TRUE(manifest.textures[1].auto_mips);
    EXPECT_EQ(manifest.textures[1].mips, 0);
    EXPECT_TRUE(manifest.textures[1].history);
    EXPECT_EQ(manifest.textures[1].clear, std::vector<double>{0.5});
    const TextureSpec& steps = manifest.textures[2];
    EXPECT_EQ(steps.grid.kind, GridSpec::Kind::size);
    EXPECT_EQ(steps.grid.size[0], 256);
    EXPECT_EQ(steps.grid.size[1], 16);
    EXPECT_EQ(steps.layers, 7);
    EXPECT_EQ(steps.mips, 5);
    EXPECT_EQ(steps.clear, (std::vector<double>{1, 2, 3, 4}));
    EXPECT_FALSE(steps.partial);
    EXPECT_TRUE(manifest.textures[3].partial);

    ASSERT_EQ(manifest.buffers.size(), 3U);
    const BufferSpec& list = *manifest.find_buffer("list");
    EXPECT_EQ(list.element, "uvec2");
    ASSERT_TRUE(list.grid.has_value());
    EXPECT_EQ(list.grid->tile.param, "tile");
    EXPECT_EQ(list.count.number, 3);
    EXPECT_TRUE(list.history);
    EXPECT_TRUE(manifest.find_buffer("args")->indirect);
    EXPECT_EQ(manifest.find_buffer("args")->clear, (std::vector<double>{4, 0, 0, 0}));
    EXPECT_EQ(manifest.find_buffer("sums")->count.param, "tile");
    EXPECT_FALSE(manifest.find_buffer("sums")->grid.has_value());

    ASSERT_TRUE(manifest.native.has_value());
    EXPECT_EQ(manifest.native->uniforms[0].type, "vec3");
    EXPECT_EQ(manifest.native->tables[0].width, 64);
    EXPECT_EQ(manifest.native->tables[0].height, 1);
    EXPECT_EQ(manifest.native->tables[1].width, 512);
    EXPECT_EQ(manifest.native->tables[1].height, 1024);
}

TEST(ManifestResources, KeepNoHistoryUnlessSomethingDoes) {
    EXPECT_FALSE(EffectFolder().sound_manifest().has_history());
}

std::string texture(const std::string& fields) {
    return R"("textures": {"small": {"doc": ".", )" + fields + "}}";
}

TEST(ManifestResources, SayWhatIsWrongWithATexture) {
    const std::vector<std::pair<std::string, Lines>> broken = {
        {R"("format": "r8", "size": [0, 4])", {"5: 'size' must be from 1 to 16384, not 0"}},
        {R"("format": "r8", "size": [4, 16385])", {"5: 'size' must be from 1 to 16384, not 16385"}},
        {R"j("format": "r8", "size": ["widht / 2", 4])j",
         {"5: 'size': in \"widht / 2\", at character 1: 'widht' is not a number that it can use (a formula "
          "has "
          "numbers, + - * /, brackets, functions, 'width' and 'height' of the working grid and parameters "
          "that are "
          "one number)"}},
        {R"("format": "r8", "size": 4)", {"5: 'size' must be an array, not an integer"}},
        {R"("format": "r8", "size": [4, 4], "tile": 8)",
         {"5: only one of 'scale', 'tile' and 'size' may be given"}},
        {R"("format": "r8", "tile": "gain")", {"5: 'tile' names 'gain', whose type is float, not int"}},
        {R"("format": "r8", "tile": "tap")",
         {"5: 'tile' names 'tap', which is not a parameter; did you mean 'taps'?"}},
        {R"("format": "r8", "tile": "taps")",
         {"5: 'tile' names 'taps', which must have a 'min' of at least 1 and a 'max' of at most 4096"}},
        {R"("format": "r8", "tile": 2.5)",
         {"5: 'tile' must be an integer or the name of an int parameter, not a number"}},
        {R"("format": "r8", "layers": 257)", {"5: 'layers' must be from 1 to 256, not 257"}},
        {R"("format": "r8", "layers": "many")", {"5: 'layers' must be an integer, not a string"}},
        {R"("format": "r8", "mips": 16)", {"5: 'mips' must be from 1 to 15, not 16"}},
        {R"("format": "r8", "mips": "all")", {"5: 'mips' is \"auto\" or a number of levels"}},
        {R"("format": "r8", "size": [8, 4], "mips": 5)",
         {"5: 'mips' is 5, but 8 texels a side have fewer levels"}},
        {R"("format": "r32ui", "mips": "auto")",
         {"5: an integer texture has no automatic 'mips': integers have no mean"}},
        {R"("format": "r32ui", "clear": 0.5)", {"5: 'clear' has 0.5, but integers need a whole number"}},
        {R"("format": "r32ui", "clear": -1)", {"5: 'clear' has -1, but r32ui holds 0 to 4294967295"}},
        {R"("format": "r8", "clear": [0, 0, 2, 0])", {"5: 'clear' has 2, but r8 holds 0 to 1"}},
        {R"("format": "r16f", "clear": 1e6)", {"5: 'clear' has 1e+06, but r16f holds -65504 to 65504"}},
        {R"("format": "r8", "clear": [0, 0])", {"5: 'clear' is one number or four, not 2"}},
        {R"("format": "r8", "clear": "black")", {"5: 'clear' must be a number or an array of numbers"}},
        {R"("format": "r8", "history": 1)", {"5: 'history' must be true or false, not an integer"}},
        {R"("format": "r8", "history": true)",
         {"5: the texture 'small' has 'history', but no pass reads 'small.prev'"}},
        {R"("format": "r8", "partial": true)",
         {"5: a 'partial' texture has an integer format, such as rgba32ui; r8 needs 'clear'"}},
        {R"("format": "r32ui", "partial": true, "clear": 0)",
         {"5: a 'partial' texture has no 'clear' and no 'history': leave out one or the other"}},
        {R"("format": "r8", "layer": 2)", {"5: texture 'small' has no key 'layer'; did you mean 'layers'?"}},
    };
    for (const auto& [fields, messages] : broken)
        test::expect_faults({{kTextures, texture(fields)}}, messages);
}

TEST(ManifestResources, SayWhatIsWrongWithAnInput) {
    const auto inputs = [](const std::string& fields) {
        return R"("inputs": {"color": {"role": "color"}, "depth": {"role": "depth", )" + fields + "}}";
    };
    test::expect_faults({{kInputs, inputs(R"("frame": 1)")}},
                        {"2: an input of another frame must be 'optional': shots begin and end"});
    for (const char* frame : {"0", "4", "-4", "1.5"})
        test::expect_faults({{kInputs, inputs(R"("optional": true, "frame": )" + std::string(frame))}},
                            {"2: 'frame' is -3 to -1 or 1 to 3: a capture before or after"});
    test::expect_faults({{kInputs, inputs(R"("frame": 1, "optional": true, "history": true)")}},
                        {"2: an input has 'frame' or 'history', not both",
                         "2: the input 'depth' has 'history', but no pass reads 'depth.prev'"});
    test::expect_faults(
        {{kInputs, inputs(R"("frame": 1, "optional": true, "from": "capture")")}},
        {"2: an input has 'frame' or 'from', not both: other frames are the capture's anyway"});
}

std::string buffer(const std::string& fields) {
    return R"("buffers": {"list": {"doc": ".", )" + fields + "}}";
}

TEST(ManifestResources, SayWhatIsWrongWithABuffer) {
    const std::string unused = "8: no pass uses the buffer 'list'";
    const std::string indirect =
        "8: the indirect buffer 'list' must have 'element' uint and a fixed 'count' of at least 4";
    const std::vector<std::pair<std::string, Lines>> broken = {
        {R"("element": "uint", "count": 4)", {unused}},
        {R"("element": "uint")", {unused, "8: buffer 'list' has at least one of 'count' and 'per'"}},
        {R"("element": "vec3", "count": 4)",
         {unused,
          "8: 'element' is 'vec3' but must be 'float', 'int', 'uint', 'vec2', 'vec4', 'ivec2', 'ivec4', "
          "'uvec2' or "
          "'uvec4'; did you mean 'vec2'?"}},
        {R"("element": "uint", "count": 0)", {unused, "8: 'count' must be from 1 to 33554432, not 0"}},
        {R"("element": "vec4", "count": 8388609)",
         {unused, "8: 'count' must be from 1 to 8388608, not 8388609"}},
        {R"("element": "uint", "per": "texel")",
         {unused, "8: 'per' is \"pixel\", {\"tile\": 16} or {\"scale\": 0.5}"}},
        {R"("element": "uint", "per": {"size": 4})",
         {unused, "8: 'per' has one of 'tile' and 'scale'",
          "8: 'per' has no key 'size'; did you mean 'tile'?"}},
        {R"("element": "uint", "per": "pixel", "count": 257)",
         {unused, "8: 'count' must be from 1 to 256, not 257"}},
        {R"("element": "uint", "count": 2, "clear": [1, 2, 3])",
         {unused, "8: 'clear' has 3 words, more than the 2 of the buffer"}},
        {R"("element": "ivec2", "count": 2, "clear": [0.5])",
         {unused, "8: 'clear' has 0.5, but integers need a whole number"}},
        {R"("element": "int", "count": 4, "indirect": true)", {unused, indirect}},
        {R"("element": "uint", "count": 3, "indirect": true)", {unused, indirect}},
        {R"("element": "uint", "per": "pixel", "indirect": true)", {unused, indirect}},
        {R"("element": "uint", "count": 4, "indirect": true, "history": true)",
         {unused, "8: the indirect buffer 'list' cannot have 'history'"}},
    };
    for (const auto& [fields, messages] : broken) test::expect_faults({{kMore, buffer(fields)}}, messages);
}

TEST(ManifestResources, SayWhatIsWrongWithNativeValues) {
    const auto native = [](const std::string& text) { return R"("native": {)" + text + "}"; };
    test::expect_faults({{kMore, native(R"("uniforms": {"warp": {"type": "mat3", "doc": "."}})")}},
                        {"8: 'type' is 'mat3' but must be 'float', 'int', 'uint', 'vec2', 'vec3' or 'vec4'"});
    test::expect_faults(
        {{kMore, native(R"("tables": {"t": {"element": "vec2", "count": 1025, "doc": "."}})")}},
        {"8: 'count' must be from 1 to 1024, not 1025"});
    test::expect_faults(
        {{kMore, native(R"("tables": {"t": {"element": "vec2", "count": [4, 4, 4], "doc": "."}})")}},
        {"8: 'count' holds 2 integers"});
    test::expect_faults(
        {{kMore, native(R"("tables": {"t": {"element": "vec3", "doc": "."}})")}},
        {"8: 'element' is 'vec3' but must be 'float', 'vec2', 'vec4', 'uint', 'uvec2' or 'uvec4'; did "
         "you mean 'vec2'?",
         "8: native table 't' has no 'count'"});
    test::expect_faults({{kMore, native(R"("table": {})")}},
                        {"8: 'native' has no key 'table'; did you mean 'tables'?"});
    test::expect_faults({{kMore, R"("accumulates": "frames")"}},
                        {"8: 'accumulates' is 'frames' but must be 'subframes'"});
}

TEST(ManifestNames, AreNoWordsOfGlslOrOfTheHost) {
    const auto named = [](const std::string& name) {
        return R"("textures": {"small": {"format": "r8", "doc": "."}, ")" + name +
               R"(": {"format": "r8", "doc": "."}})";
    };
    for (const std::string name : {"half", "sample", "filter", "vec3", "mat2x3", "input", "uint", "hvec4"})
        test::expect_faults({{kTextures, named(name)}}, {"5: texture '" + name + "' is a word of GLSL",
                                                         "5: no pass writes the texture '" + name + "'"});
    for (const std::string name : {"gl_depth", "near__far"})
        test::expect_faults({{kTextures, named(name)}},
                            {"5: texture '" + name + "' has gl_ or __, which GLSL keeps for itself",
                             "5: no pass writes the texture '" + name + "'"});
    for (const std::string name :
         {"param", "frame", "camera", "native", "main", "texture", "mix", "distance"})
        test::expect_faults(
            {{kTextures, named(name)}},
            {"5: texture '" + name + "' would hide GLSL's or the host's own '" + name + "' in its shaders",
             "5: no pass writes the texture '" + name + "'"});
    // As members of a block, names of functions hide nothing.
    test::expect_faults({{test::kPresets, R"("presets": {})"}, {kParams, R"("params": {
        "distance": {"type": "float", "default": 1, "doc": "."}, "flat": {"type": "bool", "default": true, "doc": "."}})"}},
                        {"4: parameter 'flat' is a word of GLSL"});
    test::expect_faults({{kPasses, R"("passes": [
        {"name": "filter", "shader": "a.frag", "reads": ["color", "depth"], "writes": ["small", "color"]}])"},
                         {kTextures, texture(R"("format": "r8")")}},
                        {"6: pass 'filter' is a word of GLSL"});
}

TEST(ManifestNames, DoNotMeetInGlsl) {
    const auto second = [](const std::string& name) {
        return R"("textures": {"small": {"format": "r8", "doc": "."}, ")" + name +
               R"(": {"format": "r8", "doc": "."}})";
    };
    const std::string unwritten = "5: no pass writes the texture '";
    test::expect_faults(
        {{kTextures, second("color_size")}},
        {"5: texture 'color_size' needs the GLSL name 'color_size', which the input 'color' has",
         unwritten + "color_size'"});
    test::expect_faults(
        {{kTextures, second("out_color")}},
        {"5: texture 'out_color' needs the GLSL name 'out_color', which the output 'color' has",
         unwritten + "out_color'"});
    test::expect_faults(
        {{kInputs, R"("inputs": {"color": {"role": "color", "history": true}, "depth": {"role": "depth"}})"},
         {kPasses, R"("passes": [{"name": "one", "shader": "a.frag",
        "reads": ["color", "color.prev", "depth"], "writes": ["small", "color"]}])"},
         {kTextures, R"("textures": {"small": {"format": "r8", "doc": "."},
        "color_prev": {"format": "r8", "doc": "."}})"}},
        {"5: texture 'color_prev' needs the GLSL name 'color_prev', which the input 'color' has",
         unwritten + "color_prev'"});
    test::expect_faults(
        {{test::kPresets, R"("presets": {})"}, {kParams, R"("params": {
        "mode": {"type": "enum", "values": ["fast", "good"], "default": "fast", "doc": "."},
        "mode_fast": {"type": "int", "default": 1, "bind": "define", "doc": "."}})"}},
        {"4: parameter 'mode_fast' needs the GLSL name 'MODE_FAST', which the parameter 'mode' has"});
    test::expect_faults({{kMore, R"("buffers": {"list_1": {"element": "uint", "count": 1, "doc": "."},
        "list1": {"element": "uint", "count": 1, "doc": "."}})"}},
                        {"8: buffer 'list1' needs the GLSL name 'List1Buffer', which the buffer 'list_1' has",
                         "8: no pass uses the buffer 'list_1'", "8: no pass uses the buffer 'list1'"});
}

TEST(ManifestResources, HaveAVersionOfThreeNumbers) {
    for (const std::string version : {"1", "1.0", "v1.0.0", "1.0.0-rc1", "01.0.0"})
        test::expect_faults(
            {{test::kHead, R"("aftershade": 1, "id": "demo", "summary": ".", "version": ")" + version + '"'}},
            {"1: 'version' is '" + version + "' but must be MAJOR.MINOR.PATCH, such as 1.0.0"});
}

}  // namespace
}  // namespace aftershade
