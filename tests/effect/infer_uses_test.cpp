// Reads and writes that a manifest leaves to its shaders.
#include "tests/effect/assembly.h"

namespace aftershade {
namespace {

using test::demo_manifest;
using test::EffectFolder;
using test::Lines;

const std::string kHead = "#version 450 core\n#include <pass>\n";

/// One pass with these fields that leaves out what it can, and one that uses the rest.
std::string manifest_with(const std::string& fields) {
    return demo_manifest({{test::kTextures, R"("textures": {
            "small": {"format": "rgba16f", "clear": 0, "history": true, "doc": "."},
            "wide": {"format": "rgba16f", "clear": 0, "doc": "."},
            "thin": {"format": "rgba16f", "clear": 0, "doc": "."}})"},
                          {test::kPasses, R"("passes": [
            {"name": "rest", "shader": "b.frag", "reads": ["color", "depth", "small.prev"], "writes": ["small", "wide", "thin", "color"]},
            {"name": "x", )" + fields + "}]"}});
}

/// "small, small.prev -> wide": of the last pass.
std::string flow_of(const EffectFolder& folder) {
    const EffectManifest manifest = folder.sound_manifest();
    if (manifest.passes.empty()) return "";
    std::string text;
    for (const ReadSpec& read : manifest.passes.back().reads)
        text += (text.empty() ? "" : ", ") + read.name + (read.previous ? ".prev" : "");
    text += " ->";
    for (const WriteSpec& write : manifest.passes.back().writes) text += " " + write.name;
    return text;
}

TEST(InferredUses, AreWhatTheTextFetchesAndAssignsInTheOrderOfDeclarations) {
    const EffectFolder folder(manifest_with(R"("shader": "a.frag")"));
    folder.write("a.frag",
                 kHead +
                     "#include \"part.glsl\"\nvoid main() {\n"
                     "    out_thin = part() + textureLod(wide, vec2(0), 0.0);  // texelFetch(thin)\n"
                     "    out_color = texelFetch(small_prev, ivec2(0), 0);\n}\n");
    folder.write("part.glsl", "vec4 part() { return texelFetch(color, ivec2(0), 0) * small_size.x; }\n");
    EXPECT_EQ(flow_of(folder), "color, small, small.prev, wide -> color thin");
}

TEST(InferredUses, AreNoNamesOfTheShadersOwn) {
    const EffectFolder folder(manifest_with(R"("shader": "a.frag")"));
    folder.write("a.frag",
                 kHead +
                     "struct Pair { vec4 wide; };\n"
                     "vec4 fetched(sampler2D thin) { return texelFetch(thin, ivec2(0), 0); }\n"
                     "void main() {\n    vec4 out_wide = vec4(0.0), small = vec4(1.0);\n"
                     "    Pair pair = Pair(small);\n    out_color = pair.wide + out_wide + fetched(color);\n"
                     "    /* texelFetch(wide, ivec2(0), 0) */\n}\n");
    EXPECT_EQ(flow_of(folder), " -> color")
        << "a sampler that only a function of its own takes must be named";
}

TEST(InferredUses, MayStandAfterADirective) {
    const EffectFolder folder(manifest_with(R"("shader": "a.frag")"));
    folder.write("a.frag", kHead +
                               "void main() {\n#if MODE == MODE_GOOD\n    out_thin = vec4(1);\n#endif\n"
                               "    out_color = vec4(0);\n}\n");
    EXPECT_EQ(flow_of(folder), " -> color thin");
}

TEST(InferredUses, MayStandBehindTheWordThatTheirStatementFollows) {
    const EffectFolder folder(manifest_with(R"("shader": "a.frag")"));
    folder.write("a.frag",
                 kHead +
                     "void main() {\n    int i = 0;\n    do out_thin += vec4(1);\n    while (++i < 9);\n"
                     "    if (i < 3) out_color = vec4(0);\n    else out_wide = vec4(0);\n}\n");
    EXPECT_EQ(flow_of(folder), " -> color wide thin");
}

TEST(InferredUses, ComeFromDefinesAndBothShaders) {
    const EffectFolder folder(
        manifest_with(R"("shader": "a.frag", "vertex": "d.vert", "instances": {"of": "points", "count": 9},
            "defines": {"FROM": "wide", "TO": "out_thin", "SIDES": "small_size"})"));
    folder.write("a.frag", kHead + "void main() { TO = texelFetch(FROM, ivec2(SIDES.xy), 0); }\n");
    folder.write("d.vert", kHead + "void main() { gl_Position = texelFetch(depth, ivec2(0), 0); }\n");
    EXPECT_EQ(flow_of(folder), "depth, small, wide -> thin");
}

TEST(InferredUses, FillUpWhatIsNamed) {
    const EffectFolder folder(manifest_with(
        R"("shader": "a.frag", "reads": [{"wide": {"filter": "linear", "when": {"flag": true}}}, "*"], "writes": ["thin", "*"])"));
    folder.write("a.frag",
                 kHead +
                     "void main() { out_thin = texture(wide, vec2(0)) + texelFetch(color, ivec2(0), 0);"
                     " out_color = out_thin; }\n");
    EXPECT_EQ(flow_of(folder), "color, wide -> color thin");
    const EffectManifest manifest = folder.sound_manifest();
    EXPECT_EQ(manifest.passes.back().reads.at(1).filter, gpu::Filter::linear);
    EXPECT_EQ(manifest.passes.back().reads.at(1).when.size(), 1U);
    const EffectFolder named(manifest_with(R"("shader": "a.frag", "reads": [], "writes": ["thin"])"));
    named.write("a.frag",
                kHead + "void main() { out_thin = texelFetch(wide, ivec2(0), 0); out_color = out_thin; }\n");
    EXPECT_EQ(flow_of(named), " -> thin") << "without '*' nothing is added";
}

/// As "file:line:column: error: message", without folders.
Lines faults_of(const EffectFolder& folder) {
    Diagnostics diagnostics;
    EXPECT_FALSE(folder.manifest(diagnostics).has_value());
    Lines lines;
    for (const std::string& line : test::lines_of(diagnostics))
        lines.push_back(line.substr(folder.path().string().size() + 1));
    return lines;
}

TEST(InferredUses, SayWhatTheTextNamesWrongly) {
    const EffectFolder folder(manifest_with(R"("shader": "a.frag")"));
    folder.write("a.frag", kHead + "void main() {\n    out_thin = texelFetch(wyde, ivec2(0), 0);\n}\n");
    EXPECT_EQ(faults_of(folder), Lines{"a.frag:4:27: error: pass 'x': its shader reads 'wyde', which is "
                                       "neither an input nor a texture; did you mean 'wide'?"});
    folder.write("a.frag", kHead +
                               "#ifdef HAS_MASK\nvec4 a() { return texelFetch(mask, ivec2(0), 0); }\n#endif\n"
                               "void main() { out_thin = vec4(0); }\n");
    EXPECT_EQ(flow_of(folder), " -> thin") << "what other effects have may stand within #if";
    folder.write("a.frag", kHead + "void main() {\n    out_thin = texelFetch(depth_prev, ivec2(0), 0);\n}\n");
    EXPECT_EQ(faults_of(folder),
              Lines{"a.frag:4:27: error: pass 'x': reads 'depth.prev', but 'depth' has no 'history'"});
    folder.write("a.frag", kHead + "#include \"none.glsl\"\nvoid main() { out_thin = vec4(0); }\n");
    const Lines lines = faults_of(folder);
    ASSERT_EQ(lines.size(), 1U);
    EXPECT_TRUE(lines[0].starts_with("a.frag:3:1: error: cannot read ")) << lines[0];
}

TEST(InferredUses, LeaveOutTheParametersOfMacros) {
    const EffectFolder folder(manifest_with(R"("shader": "a.frag")"));
    folder.write("a.frag",
                 kHead +
                     "#define TAP(s, p) texelFetch(s, p, 0)\n#define SUM(p) (texelFetch(wide, p, 0) * 2.0)\n"
                     "void main() { out_thin = SUM(ivec2(0)); }\n");
    EXPECT_EQ(flow_of(folder), "wide -> thin");
}

TEST(InferredUses, SayThatTheTextWritesNothing) {
    const EffectFolder folder(manifest_with(R"("shader": "a.frag")"));
    folder.write("a.frag", kHead + "void main() { out_thinn = vec4(0); }\n");
    const Lines lines = faults_of(folder);
    ASSERT_EQ(lines.size(), 1U);
    EXPECT_TRUE(
        lines[0].ends_with("pass 'x': writes nothing: it has no 'writes', and 'a.frag' has no 'out_' and the "
                           "name of an output or a texture"))
        << lines[0];
}

}  // namespace
}  // namespace aftershade
