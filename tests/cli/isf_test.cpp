// ISF files in looks: drawn, wrong, imported.
#include "tests/cli/isf_files.h"

namespace aftershade::test {
namespace {

TEST_F(IsfFiles, DrawFromTheLowerLeftCorner) {
    write_filter("ramp.fs", "", kRamp);
    const Image image = display(step("ramp.fs"));
    for (int y = 0; y < kHeight; ++y) {
        const float up = float(kHeight - y - 0.5) / kHeight;
        EXPECT_NEAR(image.at(3, y, 0), 3.5 / kWidth, 1e-6);
        EXPECT_NEAR(image.at(3, y, 1), up, 1e-6) << y;
        EXPECT_NEAR(image.at(3, y, 2), up, 1e-6) << y;
    }
}

TEST_F(IsfFiles, SampleFromTheLowerLeftCornerInEachOfTheirWays) {
    write_filter("ramp.fs", "", kRamp);
    // Each takes the pixel above and to the right.
    for (const std::string read :
         {"IMG_NORM_PIXEL(inputImage, isf_FragNormCoord + 1.0 / RENDERSIZE)",
          "IMG_PIXEL(inputImage, gl_FragCoord.xy + 1.0)",
          "texture2D(inputImage, isf_FragNormCoord + vec2(1) / IMG_SIZE(inputImage))",
          "texelFetch(inputImage, ivec2(gl_FragCoord.xy) + 1, 0)",
          "texelFetchOffset(inputImage, ivec2(gl_FragCoord.xy), 0, ivec2(1))",
          "textureOffset(inputImage, isf_FragNormCoord, ivec2(1))",
          "textureGrad(inputImage, isf_FragNormCoord + 1.0 / RENDERSIZE, vec2(0.0), vec2(0.0))",
          "texture2DProj(inputImage, vec4(2.0 * isf_FragNormCoord + 2.0 / RENDERSIZE, 0.0, 2.0))",
          "vec4(textureGather(inputImage, isf_FragNormCoord + 0.5 / RENDERSIZE, 0).y,"
          " textureGather(inputImage, isf_FragNormCoord + 0.5 / RENDERSIZE, 1).y, 0.0, 1.0)"}) {
        write_filter("shift.fs", kImage, "void main() { gl_FragColor = " + read + "; }\n");
        const Image image = display(step("ramp.fs") + "," + step("shift.fs"));
        EXPECT_NEAR(image.at(3, 5, 0), 4.5 / kWidth, 1e-6) << read;
        EXPECT_NEAR(image.at(3, 5, 1), 3.5 / kHeight, 1e-6) << read;
    }
}

TEST_F(IsfFiles, HaveTheBitsOfTheWholeFrameInARegion) {
    write_filter("ramp.fs", "", kRamp);
    const Image whole = display(step("ramp.fs"));
    run(step("ramp.fs"), {"in_0001.exr", "-o", "out.exr", "--output-roles", "display", "--pixel-type",
                          "float", "--region", "5,2,6,4"});
    const Image region = read(folder_ / "out.exr", "display.");
    for (int c = 0; c < 4; ++c) EXPECT_EQ(region.at(1, 1, c), whole.at(6, 3, c)) << c;
}

TEST_F(IsfFiles, SeeADefaultThatIsNoneOfTheirValues) {
    write_filter("odd.fs", R"("INPUTS": [{"NAME": "l", "TYPE": "long", "VALUES": [3, 7], "DEFAULT": 5}])",
                 "void main() { gl_FragColor = vec4(float(l) / 10.0); }\n");
    EXPECT_FLOAT_EQ(display(step("odd.fs")).at(2, 2, 0), 0.5f);
}

TEST_F(IsfFiles, UndoAndRedoThePremultiplicationOfLinearLight) {
    write_filter("half.fs", kImage,
                 "void main() { vec4 c = IMG_THIS_PIXEL(inputImage); gl_FragColor = vec4(c.rgb * 2.0, c.a * "
                 "0.5); }\n");
    run(step("half.fs", R"(, "space": "linear")"), {"in_0001.exr", "-o", "out.exr", "--pixel-type", "float"});
    const Image image = read(folder_ / "out.exr", "");
    // Straight (0.5, 1, 2), twice that, times an alpha of 0.25.
    for (const auto& [channel, expected] : {std::pair(0, 0.25), {1, 0.5}, {2, 1.0}, {3, 0.25}})
        EXPECT_NEAR(image.at(2, 2, channel), expected, 1e-6) << channel;
}

TEST_F(IsfFiles, KeepTheirBuffersUntilACut) {
    write_filter("count.fs", R"("PASSES": [{"TARGET": "last", "PERSISTENT": true, "FLOAT": true}, {}])",
                 "void main() { gl_FragColor = IMG_THIS_PIXEL(last) + (PASSINDEX == 0 ? vec4(0.125) : "
                 "vec4(0.0)); }\n");
    write_text(folder_ / "capture.json", R"({"aftershade": 1, "frames": "in_####.exr", "cuts": [3]})");
    run(step("count.fs"), {"capture.json", "-o", "out_####.exr", "--output-roles", "display"});
    for (const auto& [frame, expected] : {std::pair(1, 0.125), {2, 0.25}, {3, 0.125}, {4, 0.25}})
        EXPECT_EQ(read(folder_ / ("out_000" + std::to_string(frame) + ".exr"), "display.").at(0, 0, 0),
                  expected)
            << frame;
}

/// Every part of the format that reaches a shader.
void write_everything(const fs::path& folder) {
    write_text(
        folder / "All Of It.fs",
        isf_file(R"j("INPUTS": [{"NAME": "inputImage", "TYPE": "image"}, {"NAME": "mask", "TYPE": "image"},
{"NAME": "mode", "TYPE": "long", "VALUES": [2, 5], "LABELS": ["Two", "Five"], "DEFAULT": 5},
{"NAME": "frame", "TYPE": "float", "DEFAULT": 0.25}, {"NAME": "sample", "TYPE": "color", "DEFAULT": [0.1, 0.2, 0.3, 1]},
{"NAME": "wave", "TYPE": "audio"}, {"NAME": "go", "TYPE": "event"}],
"PASSES": [{"TARGET": "small", "WIDTH": "floor($WIDTH / 3.0)", "HEIGHT": "max($HEIGHT * $frame, 2)"},
{"TARGET": "last", "PERSISTENT": true}])j",
                 R"(#version 120
#extension GL_EXT_gpu_shader4 : enable
varying vec2 above;
uniform vec3 unused;
vec4 param(vec4 buffer) { return buffer * frame; }
void main() {
    vec4 filter = PASSINDEX == 0 ? texture2D(inputImage, above) : IMG_THIS_NORM_PIXEL(small);
    if (mode == 5 && !go) filter += sample;
    gl_FragColor = param(filter) + IMG_THIS_PIXEL(mask) + IMG_NORM_PIXEL(wave, vec2(0.5)) + 0.5 * IMG_THIS_PIXEL(last);
    gl_FragColor.a = 1;
}
)"));
    write_text(folder / "All Of It.vs",
               "varying vec2 above;\nvoid main() { isf_vertShaderInit(); above = isf_FragNormCoord + "
               "vec2(0.0, 0.25); }\n");
}

TEST_F(IsfFiles, GiveTheSameBitsWhenImported) {
    write_filter("ramp.fs", "", kRamp);
    write_everything(folder_ / "filters");
    fs::create_directories(folder_ / "mine");
    const auto render = [&](const std::string& effect, const std::string& out) {
        write_text(folder_ / "capture.json", R"({"aftershade": 1, "frames": "in_####.exr"})");
        run(step("ramp.fs") + R"(, {"effect": ")" + effect + R"(", "name": "filter"})",
            {"capture.json", "-o", out + "_####.exr", "--output-roles", "display", "--pixel-type", "float",
             "--effect-path", "mine"});
    };
    render("filters/All Of It.fs", "file");
    const CommandResult made =
        run_aftershade({"import", "isf", "filters/All Of It.fs", "-o", "mine/all_of_it"}, folder_.path());
    ASSERT_EQ(made.exit_code, 0) << made.err;
    EXPECT_EQ(run_aftershade({"check", "mine/all_of_it", "--no-gl"}, folder_.path()).exit_code, 0);
    render("all_of_it", "native");
    for (const char* frame : {"_0001.exr", "_0004.exr"}) {
        const Image file = read(folder_ / (std::string("file") + frame), "display.");
        const Image native = read(folder_ / (std::string("native") + frame), "display.");
        EXPECT_EQ(std::vector<float>(file.floats().begin(), file.floats().end()),
                  std::vector<float>(native.floats().begin(), native.floats().end()));
    }
    const CommandResult again =
        run_aftershade({"import", "isf", "filters/All Of It.fs", "-o", "mine/all_of_it"}, folder_.path());
    EXPECT_EQ(again.exit_code, 2) << "nothing is overwritten";
}

TEST_F(IsfFiles, TellFaultsOfTheirShadersWithTheLine) {
    struct Fault {
        std::string shader;
        int line;
        std::string message;
    };
    // Lines of the file, where the shader begins at line 4; the compiler finds an #if without end behind it.
    const std::vector<Fault> faults = {
        {"void main() {\n gl_FragColor = vec4(1.0)\n}\n", 6, "syntax error"},
        {"void main() {\n gl_FragColor = blur(1.0);\n}\n", 5, "blur"},
        {"void main() {\n gl_FragColor = vec4(1.0);\n", 5, "syntax error"},
        {"void main() {\n gl_FragColor = vec3(1.0);\n}\n", 5, "vec3"},
        {"void main() {\n gl_FragColor = IMG_THIS_PIXEL(other);\n}\n", 5, "other"},
        {"void main() {\n gl_FragColor = vec4(amount);\n}\n", 5, "amount"},
        {"float f(float x) { return f(x); }\nvoid main() { gl_FragColor = vec4(f(1.0)); }\n", 4, "recursion"},
        {"#if 1\nvoid main() { gl_FragColor = vec4(1.0); }\n", 0, "#if"},
        {"#if 0\n\nvoid main() { gl_FragColor = vec4(1.0); }\n#endif\n", 6, "'main'"},
        {"float x = 1.0;\nvoid main() { gl_FragColor = vec4(x); main(); }\n", 5, "main()"},
        {"void main() {\n float smooth = 1.0;\n gl_FragColor = smooth;\n}\n", 6, "vec4"},
        {"void main() {\n gl_FragColor = flat;\n}\n", 5, "`flat' undeclared"},
    };
    for (const Fault& fault : faults) {
        write_filter("x.fs", kImage, fault.shader);
        const std::string place = fault.line > 0 ? "x.fs:" + std::to_string(fault.line) + ":" : "x.fs";
        const CommandResult result =
            run(step("x.fs", R"(, "space": "linear")"), {"in_0001.exr", "-o", "out.exr"}, 5);
        EXPECT_NE(result.err.find(place), std::string::npos) << fault.shader << result.err;
        EXPECT_NE(result.err.find(fault.message), std::string::npos) << fault.shader << result.err;
        EXPECT_FALSE(fs::exists(folder_ / "out.exr")) << fault.shader << result.err;
    }
}

TEST_F(IsfFiles, AreListedAndDescribedByTheirNames) {
    write_filter("Edge Blur.fs",
                 R"("DESCRIPTION": "Blurs edges.", "INPUTS": [{"NAME": "blurAmount", "TYPE": "float"}])",
                 kRamp);
    const CommandResult list = run_aftershade({"list", "--effect-path", "filters"}, folder_.path());
    EXPECT_NE(list.out.find("edge_blur"), std::string::npos) << list.out;
    for (const char* name : {"Edge Blur", "edge_blur", "filters/Edge Blur.fs"}) {
        const CommandResult text =
            run_aftershade({"describe", name, "--effect-path", "filters"}, folder_.path());
        EXPECT_NE(text.out.find("blur_amount"), std::string::npos) << name << text.err;
    }
    run(R"({"effect": "Edge Blur"})", {"in_0001.exr", "-o", "out.png", "--effect-path", "filters"});
}

TEST_F(IsfFiles, SayWhereTheyBelong) {
    write_filter("tint.fs", kImage, "void main() { gl_FragColor = IMG_THIS_PIXEL(inputImage); }\n");
    const CommandResult early = run(step("tint.fs"), {"in_0001.exr", "-o", "out.png"}, 3);
    EXPECT_NE(early.err.find("\"space\": \"linear\""), std::string::npos) << early.err;
    const CommandResult lost = run(R"({"effect": "view_transform"},)" + step("tint.fs") +
                                       R"(,{"effect": "view_transform", "name": "again"})",
                                   {"in_0001.exr", "-o", "out.png"}, 2);
    EXPECT_NE(lost.err.find("'again' reads color after a step has made display"), std::string::npos)
        << lost.err;
    const CommandResult missing = run(step("tnit.fs"), {"in_0001.exr", "-o", "out.png"}, 2);
    EXPECT_NE(missing.err.find("did you mean 'filters/tint.fs'"), std::string::npos) << missing.err;
    const CommandResult space =
        run(R"({"effect": "view_transform", "space": "linear"})", {"in_0001.exr", "-o", "out.png"}, 2);
    EXPECT_NE(space.err.find("is not an ISF file"), std::string::npos) << space.err;
}

}  // namespace
}  // namespace aftershade::test
