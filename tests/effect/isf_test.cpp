#include "framework/effect/isf/isf_effect.h"

#include <gtest/gtest.h>

#include "framework/effect/registry.h"
#include "framework/effect/usage_check.h"
#include "tests/effect/broken_isf.h"
#include "tests/temporary_folder.h"

namespace aftershade {
namespace {

const std::filesystem::path kIsfGlsl = std::filesystem::path(AFTERSHADE_SOURCE_DIR) / "glsl";

/// A manifest of a file in a folder; a fault ends the test.
EffectManifest isf_manifest_of(const test::TemporaryFolder& folder, const std::string& text,
                               IsfSpace space = IsfSpace::display) {
    test::write_text(folder / "Half Size.fs", text);
    Diagnostics diagnostics;
    auto manifest = read_isf_manifest(folder / "Half Size.fs", space, kIsfGlsl, diagnostics);
    for (const Diagnostic& fault : diagnostics.all())
        ADD_FAILURE() << to_string(fault.place) << fault.message;
    return manifest.value_or(EffectManifest{});
}

TEST(BrokenIsfFile, HasOneMessageWithItsLine) {
    const std::vector<test::BrokenIsf> files = test::broken_isf_files();
    EXPECT_GE(files.size(), 40U);
    for (const test::BrokenIsf& broken : files) {
        const test::TemporaryFolder folder;
        test::write_text(folder / "x.fs", broken.text);
        Diagnostics diagnostics;
        EXPECT_FALSE(read_isf_manifest(folder / "x.fs", IsfSpace::display, kIsfGlsl, diagnostics))
            << broken.name;
        ASSERT_EQ(diagnostics.all().size(), 1U) << broken.name;
        const Diagnostic& fault = diagnostics.all().front();
        EXPECT_EQ(fault.place.file, (folder / "x.fs").string()) << broken.name;
        EXPECT_EQ(fault.place.line, broken.line) << broken.name << ": " << fault.message;
        EXPECT_NE(fault.message.find(broken.message), std::string::npos)
            << broken.name << ": " << fault.message;
    }
}

TEST(IsfInputs, BecomeParametersOfTheirTypes) {
    const test::TemporaryFolder folder;
    const EffectManifest manifest = isf_manifest_of(
        folder,
        test::isf_file(
            R"j("INPUTS": [
        {"NAME": "inputImage", "TYPE": "image"},
        {"NAME": "blurAmount", "TYPE": "float", "MIN": 0, "MAX": 4, "DEFAULT": 9, "IDENTITY": 0},
        {"NAME": "RGBMode", "TYPE": "long", "VALUES": [5, 7], "LABELS": ["Low", "2x High"], "DEFAULT": 7},
        {"NAME": "count", "TYPE": "long", "MIN": 1, "MAX": 8, "DEFAULT": 3},
        {"NAME": "on", "TYPE": "bool", "DEFAULT": 1.0}, {"NAME": "go", "TYPE": "event"},
        {"NAME": "tint", "TYPE": "color", "DEFAULT": [0.5, 0, 1]},
        {"NAME": "center", "TYPE": "point2D", "DEFAULT": [0.5, 0.25], "MIN": [0, 0], "MAX": [1, 1]},
        {"NAME": "wave", "TYPE": "audio"}])j",
            "void main() { gl_FragColor = IMG_THIS_PIXEL(inputImage) + IMG_NORM_PIXEL(wave, center); }\n"));
    EXPECT_EQ(manifest.id, "half_size");
    ASSERT_EQ(manifest.inputs.size(), 1U);
    EXPECT_EQ(manifest.inputs[0].name, "input_image");
    EXPECT_EQ(manifest.inputs[0].role, "display");
    const auto param = [&](const char* name) -> const ParamSpec& { return *manifest.find_param(name); };
    EXPECT_EQ(param("blur_amount").default_value, ParamValue(9.0));
    EXPECT_EQ(param("blur_amount").max, 9.0) << "a default beyond MAX moves the limit";
    EXPECT_EQ(param("blur_amount").identity, ParamValue(0.0));
    EXPECT_EQ(param("rgb_mode").values, (std::vector<std::string>{"low", "2x_high"}));
    EXPECT_EQ(param("rgb_mode").default_value, ParamValue("2x_high"));
    EXPECT_EQ(param("count").default_value, ParamValue(std::int64_t(3)));
    EXPECT_EQ(param("on").default_value, ParamValue(true));
    EXPECT_EQ(param("go").default_value, ParamValue(false));
    EXPECT_EQ(param("tint").default_value, ParamValue(std::vector<double>{0.5, 0, 1, 1}));
    EXPECT_EQ(param("center").default_value, ParamValue(std::vector<double>{0.5, 0.25}));
    EXPECT_EQ(param("wave").type, ParamType::file);
}

TEST(IsfInputs, TakeNumbersAsLabelsNullAsNoListAndAllOf32Bits) {
    const test::TemporaryFolder folder;
    const EffectManifest manifest =
        isf_manifest_of(folder, test::isf_file(R"j("CREDIT": ["me", 1984], "INPUTS": [
        {"NAME": "side", "TYPE": "long", "VALUES": null, "LABELS": [8, 16]},
        {"NAME": "least", "TYPE": "long", "VALUES": [0], "DEFAULT": -2147483648, "MIN": -2147483648}])j"));
    EXPECT_EQ(manifest.find_param("side")->values, (std::vector<std::string>{"8", "16"}));
    EXPECT_EQ(manifest.find_param("least")->min, -2147483648.0);
    EXPECT_TRUE(manifest.sources.at(0).ends_with(", me, 1984")) << manifest.sources.at(0);
}

TEST(IsfInputs, WarnOfNumbersThatAPointDoesNotTake) {
    const test::TemporaryFolder folder;
    test::write_text(folder / "x.fs",
                     test::isf_input("\"NAME\": \"at\", \"TYPE\": \"point2D\", \"DEFAULT\": [1, 2, 3, 4]"));
    Diagnostics diagnostics;
    const auto manifest = read_isf_manifest(folder / "x.fs", IsfSpace::display, kIsfGlsl, diagnostics);
    ASSERT_EQ(diagnostics.all().size(), 1U);
    EXPECT_EQ(diagnostics.all()[0].place.line, 3);
    EXPECT_NE(diagnostics.all()[0].message.find("a list of 4, of which the first 2 numbers count"),
              std::string::npos)
        << diagnostics.all()[0].message;
    EXPECT_EQ(manifest.value().find_param("at")->default_value, ParamValue(std::vector<double>{1, 2}));
}

/// The time once grew with the cube of their number, so that this did not end.
TEST(IsfInputs, NameThousandsOfEqualLabelsAtOnce) {
    const test::TemporaryFolder folder;
    std::string values, labels;
    for (int i = 0; i < 3000; ++i) {
        values += (i > 0 ? "," : "") + std::to_string(i);
        labels += i > 0 ? ",\"\"" : "\"\"";
    }
    const EffectManifest manifest = isf_manifest_of(
        folder, test::isf_file(R"j("INPUTS": [{"NAME": "side", "TYPE": "long", "VALUES": [)j" + values +
                               R"j(], "LABELS": [)j" + labels + "]}]"));
    ASSERT_EQ(manifest.find_param("side")->values.size(), 3000U);
    EXPECT_EQ(manifest.find_param("side")->values[0], "value");
    EXPECT_EQ(manifest.find_param("side")->values[2999], "value_3000");
}

TEST(BrokenIsfVertexShader, HasNoNulByte) {
    const test::TemporaryFolder folder;
    test::write_text(folder / "x.fs", test::isf_file("\"INPUTS\": []"));
    test::write_text(folder / "x.vs", std::string("void main() {\n isf_vertShaderInit();\n}\n\0", 40));
    Diagnostics diagnostics;
    EXPECT_FALSE(read_isf_manifest(folder / "x.fs", IsfSpace::display, kIsfGlsl, diagnostics));
    ASSERT_EQ(diagnostics.all().size(), 1U);
    EXPECT_EQ(diagnostics.all()[0].place.file, (folder / "x.vs").string());
    EXPECT_EQ(diagnostics.all()[0].place.line, 4);
}

TEST(IsfPasses, ReadWhatThisFrameHasWrittenAndElseWhatTheLastLeft) {
    const test::TemporaryFolder folder;
    const EffectManifest manifest =
        isf_manifest_of(folder, test::isf_file(R"j("INPUTS": [{"NAME": "inputImage", "TYPE": "image"}],
        "PASSES": [{"TARGET": "small", "WIDTH": "floor($WIDTH/4.0)", "HEIGHT": 2}, {"TARGET": "last", "PERSISTENT": true, "FLOAT": true}, {}])j",
                                               "void main() { gl_FragColor = IMG_THIS_PIXEL(inputImage) + "
                                               "IMG_THIS_PIXEL(small) + IMG_THIS_PIXEL(last); }\n"));
    const TextureSpec& small = *manifest.find_texture("small");
    EXPECT_EQ(small.format, gpu::TextureFormat::rgba8);
    EXPECT_EQ(small.grid.formula[0], "floor(width/4.0)");
    EXPECT_EQ(small.grid.formula[1], "2");
    EXPECT_FALSE(small.history);
    EXPECT_EQ(manifest.find_texture("last")->format, gpu::TextureFormat::rgba32f);
    EXPECT_TRUE(manifest.find_texture("last")->history);
    std::vector<std::string> reads;
    for (const PassSpec& pass : manifest.passes)
        for (const ReadSpec& read : pass.reads) reads.push_back(pass.name + " " + read.glsl_name());
    EXPECT_EQ(reads, (std::vector<std::string>{"pass_0 input_image", "pass_0 last_prev", "pass_0 nothing",
                                               "pass_1 input_image", "pass_1 small", "pass_1 last_prev",
                                               "pass_2 input_image", "pass_2 small", "pass_2 last"}));
    Diagnostics diagnostics;
    check_declared_used(manifest, kIsfGlsl, diagnostics);
    for (const Diagnostic& fault : diagnostics.all())
        ADD_FAILURE() << to_string(fault.place) << fault.message;
}

TEST(IsfVersion1, KeepsTheBuffersThatItLists) {
    const test::TemporaryFolder folder;
    const EffectManifest manifest = isf_manifest_of(
        folder, test::isf_file(R"j("PERSISTENT_BUFFERS": {"last": {"WIDTH": "$WIDTH / 2"}},
        "PASSES": [{"TARGET": "last"}])j",
                               "void main() { gl_FragColor = IMG_NORM_PIXEL(last, vv_FragNormCoord); }\n"));
    EXPECT_TRUE(manifest.find_texture("last")->history);
    EXPECT_EQ(manifest.find_texture("last")->grid.formula[0], "width / 2");
    EXPECT_EQ(manifest.passes.back().name, "present") << "the last pass has a target, which is the picture";
}

TEST(IsfSpaceLinear, TakesColorWithoutItsPremultiplication) {
    const test::TemporaryFolder folder;
    const EffectManifest manifest =
        isf_manifest_of(folder,
                        test::isf_file(R"j("INPUTS": [{"NAME": "inputImage", "TYPE": "image"}])j",
                                       "void main() { gl_FragColor = IMG_THIS_PIXEL(inputImage); }\n"),
                        IsfSpace::linear);
    EXPECT_EQ(manifest.inputs[0].role, "color");
    EXPECT_EQ(manifest.outputs[0].role, "color");
    EXPECT_EQ(manifest.passes.front().name, "straight_input_image");
}

TEST(Registry, HasIsfFilesByTheirNameAndPath) {
    const test::TemporaryFolder folder;
    test::write_text(folder / "Edge Blur.fs", test::isf_file("\"DESCRIPTION\": \"Blurs.\""));
    EffectRegistry effects({folder.path()}, kIsfGlsl);
    EXPECT_EQ(effects.ids(), std::vector<std::string>{"Edge Blur"});
    Diagnostics diagnostics;
    for (const std::string& id :
         {std::string("Edge Blur"), std::string("edge_blur"), (folder / "Edge Blur.fs").string()}) {
        ASSERT_TRUE(effects.contains(id)) << id;
        const EffectManifest* manifest = effects.find(id, diagnostics);
        ASSERT_NE(manifest, nullptr) << id;
        EXPECT_EQ(manifest->id, "edge_blur");
        EXPECT_EQ(manifest->summary, "Blurs.");
    }
    EXPECT_FALSE(effects.contains("Edge.fs"));
}

}  // namespace
}  // namespace aftershade
