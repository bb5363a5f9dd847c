// ISF files in the words of other versions of GLSL and of other hosts.
#include "tests/cli/isf_files.h"

#include <sys/stat.h>

#include <algorithm>
#include <regex>
#include <set>

namespace aftershade::test {
namespace {

class IsfDialect : public IsfFiles {
protected:
    /// What the pixel at 3, 5 holds of a ramp that the filter has as its input.
    std::vector<float> pixel(const std::string& members, const std::string& shader) {
        write_filter("ramp.fs", "", kRamp);
        write_filter("x.fs", members, shader);
        const Image image = display(step("ramp.fs") + "," + step("x.fs"));
        return {image.at(3, 5, 0), image.at(3, 5, 1), image.at(3, 5, 2), image.at(3, 5, 3)};
    }
    const std::vector<float> ramp_ = {3.5f / kWidth, 2.5f / kHeight, 2.5f / kHeight, 1.0f};
    const std::vector<float> quarter_ = std::vector<float>(4, 0.25f);
};

TEST_F(IsfDialect, DrawsWhatAnOutputOfTheFilesOwnHolds) {
    for (const std::string output : {"out vec4 color;", "layout(location = 0) out highp vec4 color;",
                                     "out vec4 isf_FragColor;\n#define color isf_FragColor"})
        EXPECT_EQ(pixel(kImage, "#version 330\n" + output +
                                    "\nvoid main() { color = IMG_THIS_PIXEL(inputImage); }\n"),
                  ramp_)
            << output;
    EXPECT_EQ(pixel(kImage,
                    "out vec3 color;\nvoid main() { color = texture(inputImage, isf_FragNormCoord).rgb; }\n"),
              ramp_);
}

TEST_F(IsfDialect, TellsAnImageFromASwizzleOfItsName) {
    for (const std::string name : {"b", "r", "x", "xy", "rgb", "a", "st"}) {
        const std::string read =
            "struct Part { float " + name + "; };\nvoid main() {\n vec4 q = IMG_THIS_PIXEL(" + name +
            ");\n Part part;\n part." + name + " = q.a;\n gl_FragColor = vec4(q.rgb, part." + name +
            ").rgba;\n gl_FragColor.b = q.b;"
            " gl_FragColor.xy = q.xy; gl_FragColor.st = q.st; }\n";
        EXPECT_EQ(pixel(R"("INPUTS": [{"NAME": ")" + name + R"(", "TYPE": "image"}])", read), ramp_) << name;
        std::string target = read;
        target.insert(target.find("void main() {") + 13,
                      "if (PASSINDEX == 0) { gl_FragColor = IMG_THIS_PIXEL(inputImage); return; }");
        EXPECT_EQ(pixel(kImage + R"(, "PASSES": [{"TARGET": ")" + name + R"(", "FLOAT": true}, {}])", target),
                  ramp_)
            << name;
    }
}

/// Keywords and reserved words of GLSL 1.30 to 4.50 and functions since 1.20, as older files name things.
TEST_F(IsfDialect, TakesNamesThatLaterVersionsOfGlslHaveForThemselves) {
    const std::vector<std::string> words = {
        "smooth",     "flat",    "layout",     "uint",       "uvec2",   "sample",     "buffer",
        "shared",     "precise", "common",     "active",     "filter",  "resource",   "input",
        "output",     "half",    "double",     "dvec3",      "switch",  "case",       "default",
        "image2D",    "union",   "this",       "template",   "packed",  "inline",     "long",
        "isampler2D", "texture", "textureLod", "texelFetch", "sampler", "subroutine", "coherent",
        "readonly",   "patch",   "interface",  "noise",      "frame",   "param",      "pass",
        "camera",     "native",  "lights",     "mat2x3"};
    std::string inputs, functions, variables, sum;
    for (const std::string& word : words) {
        functions += "float f_" + word + "(float " + word + ") { return " + word + " * 1.0; }\n";
        variables +=
            " { float " + word + " = 0.5; " + word + " *= 2.0; sum += f_" + word + "(" + word + "); }\n";
        inputs += R"(, {"NAME": ")" + word + R"(", "TYPE": "float", "DEFAULT": 1})";
        sum += " + " + word;
    }
    const std::string count = std::to_string(words.size()) + ".0";
    const std::string main =
        "void main() {\n float sum = 0.0 * texture2D(inputImage, isf_FragNormCoord).r;\n";
    EXPECT_EQ(
        pixel(kImage, functions + main + variables + " gl_FragColor = vec4(0.25 * sum / " + count + "); }\n"),
        quarter_);
    EXPECT_EQ(pixel(R"("INPUTS": [{"NAME": "inputImage", "TYPE": "image"})" + inputs + "]",
                    main + " gl_FragColor = vec4(0.25 * (sum" + sum + ") / " + count + "); }\n"),
              quarter_);
    for (const std::string& word : words) {
        if (word == "noise") continue;
        EXPECT_EQ(
            pixel("", "float " + word +
                          "(float a, float b, bool c) { return a * b; }\nvoid main() { gl_FragColor = vec4(" +
                          word + "(0.5, 0.5, true)); }\n"),
            quarter_)
            << word;
        if (word.starts_with("f")) {
            EXPECT_EQ(pixel(R"("INPUTS": [{"NAME": ")" + word + R"(", "TYPE": "image"}])",
                            "void main() { gl_FragColor = texture2D(" + word + ", isf_FragNormCoord); }\n"),
                      ramp_)
                << word;
        }
    }
}

TEST_F(IsfDialect, StillTakesTheKeywordsThemselves) {
    EXPECT_EQ(pixel(kImage, R"(#version 330
layout(location = 0) out vec4 color;
uint twice(uint number) { return number * 2u; }
void main() {
    precise float part = 0.0;
    switch (int(twice(uint(1)))) {
        case 2: part = 0.25; break;
        default: part = 1.0;
    }
    color = vec4(part);
}
)"),
              quarter_);
}

/// Every word that glsl/isf/ and the files that it includes declare or define, and the blocks of <pass>.
std::set<std::string> words_of_the_host() {
    std::set<std::string> words = {"ParamBlock",  "FrameBlock",  "SizeBlock",
                                   "CameraBlock", "param",       "frame",
                                   "camera",      "out_display", "aftershade_author_main",
                                   "HAS_MASK"};
    std::vector<fs::path> files{fs::path(AFTERSHADE_SOURCE_DIR) / "glsl/coverage.glsl"};
    for (const auto& entry : fs::directory_iterator(fs::path(AFTERSHADE_SOURCE_DIR) / "glsl/isf"))
        files.push_back(entry.path());
    const std::regex word(R"(\b(isf_\w+|ISF_\w+|has_\w+|straight_\w+|k[A-Z]\w+)\b)");
    for (const fs::path& file : files) {
        const std::string text = read_text(file);
        for (std::sregex_iterator at(text.begin(), text.end(), word), end; at != end; ++at)
            words.insert((*at)[1]);
    }
    words.erase("isf_FragNormCoord");
    words.erase("isf_vertShaderInit");
    return words;
}

TEST_F(IsfDialect, TakesEveryNameThatTheHostsOwnTextHas) {
    const std::set<std::string> words = words_of_the_host();
    EXPECT_GT(words.size(), 40U);
    std::string functions, constants, macros, calls, sum;
    for (const std::string& word : words) {
        functions += "float " + word + "(float x, int y) { return x; }\n";
        calls += " + " + word + "(1.0, 0)";
        constants += "const float " + word + " = 1.0;\n";
        macros += "#define " + word + " 1.0\n";
        sum += " + " + word;
    }
    const std::string count = std::to_string(words.size()) + ".0";
    const auto main = [&](const std::string& terms) {
        return "void main() { gl_FragColor = vec4(0.25 * (0.0" + terms + ") / " + count +
               ") + 0.0 * IMG_NORM_PIXEL(inputImage, isf_FragNormCoord); }\n";
    };
    EXPECT_EQ(pixel(kImage, functions + main(calls)), quarter_);
    EXPECT_EQ(pixel(kImage, constants + main(sum)), quarter_);
    EXPECT_EQ(pixel(kImage, macros + main(sum)), quarter_);
}

TEST_F(IsfDialect, HasTheVariablesThatHostsGiveAnImage) {
    EXPECT_EQ(pixel(kImage, "void main() { gl_FragColor = vec4(_inputImage_imgSize / 64.0, 0.0, 1.0); }\n"),
              (std::vector<float>{0.25f, 0.125f, 0.0f, 1.0f}));
    EXPECT_EQ(
        pixel(kImage, "void main() { gl_FragColor = _inputImage_flip ? vec4(1.0) : _inputImage_imgRect; }\n"),
        (std::vector<float>{0, 0, 1, 1}));
    EXPECT_EQ(
        pixel(
            kImage,
            "uniform sampler2D inputImage;\nuniform vec2 RENDERSIZE;\nuniform vec2 _inputImage_imgSize;\n"
            "varying vec2 isf_FragNormCoord;\nvoid main() { gl_FragColor = VVSAMPLER_2DBYNORM(inputImage, "
            "_inputImage_imgRect, _inputImage_imgSize, _inputImage_flip, gl_FragCoord.xy / RENDERSIZE); }\n"),
        ramp_);
}

TEST_F(IsfDialect, FindsFilesWhoseEndingsAreCapitals) {
    write_filter("ramp.FS", "", "varying vec2 at;\nvoid main() { gl_FragColor = vec4(at, 0.0, 1.0); }\n");
    write_text(folder_ / "filters/ramp.VS",
               "varying vec2 at;\nvoid main() { isf_vertShaderInit(); at = isf_FragNormCoord; }\n");
    EXPECT_NEAR(display(step("ramp.FS")).at(3, 5, 0), 3.5 / kWidth, 1e-6);
    run(R"({"effect": "ramp"})", {"in_0001.exr", "-o", "out.png", "--effect-path", "filters"});
}

TEST_F(IsfDialect, TakesTheNumbersOfALongInput) {
    const auto value = [&](const std::string& labels, const std::string& set) {
        write_filter(
            "long.fs",
            R"("INPUTS": [{"NAME": "mode", "TYPE": "long", "VALUES": [0, 4, -8], "LABELS": )" + labels + "}]",
            "void main() { gl_FragColor = vec4(abs(float(mode)) / 16.0); }\n");
        run(step("long.fs"),
            {"in_0001.exr", "-o", "out.exr", "--output-roles", "display", "--set", "long.mode=" + set});
        return read(folder_ / "out.exr", "display.").at(2, 2, 0);
    };
    EXPECT_EQ(value(R"(["Off", "On", "Far"])", "on"), 0.25f);
    EXPECT_EQ(value(R"(["Off", "On", "Far"])", "4"), 0.25f);
    EXPECT_EQ(value(R"(["Off", "On", "Far"])", "-8"), 0.5f);
    EXPECT_EQ(value(R"([0, 4, -8])", "4"), 0.25f) << "labels that are numbers";
    EXPECT_EQ(value(R"(["0", "1", "2"])", "1"), 0.25f) << "a label goes before a value";
    EXPECT_EQ(value(R"(["1", "-1", "0"])", "1"), 0.0f) << "1 is not -1";
    const CommandResult wrong =
        run(step("long.fs"), {"in_0001.exr", "-o", "out.exr", "--set", "long.mode=7"}, 2);
    EXPECT_NE(wrong.err.find("minus_1"), std::string::npos) << wrong.err;
}

TEST_F(IsfDialect, SaysThatWhatTheStepNamesIsNoFile) {
    fs::create_directories(folder_ / "filters/folder.fs");
    ASSERT_EQ(::mkfifo((folder_ / "filters/pipe.fs").c_str(), 0600), 0);
    EXPECT_NE(run(step("folder.fs"), {"in_0001.exr", "-o", "out.exr"}, 2)
                  .err.find("is a folder, but an ISF file is needed"),
              std::string::npos);
    EXPECT_NE(
        run(step("pipe.fs"), {"in_0001.exr", "-o", "out.exr"}, 2).err.find("is a pipe or a device, but"),
        std::string::npos);
}

TEST_F(IsfDialect, SaysWhichTwoFilesHaveTheIdThatALookNames) {
    write_filter("Edge Blur.fs", "", kRamp);
    write_filter("edge-blur.fs", "", kRamp);
    const CommandResult both =
        run(R"({"effect": "edge_blur"})", {"in_0001.exr", "-o", "out.png", "--effect-path", "filters"}, 2);
    EXPECT_NE(both.err.find("Edge Blur.fs"), std::string::npos) << both.err;
    EXPECT_NE(both.err.find("edge-blur.fs"), std::string::npos) << both.err;
    run(R"({"effect": "Edge Blur"})", {"in_0001.exr", "-o", "out.png", "--effect-path", "filters"});
}

TEST_F(IsfDialect, ReadsInALaterPassWhatAnEarlierOneDrewIntoTheSamePersistentTarget) {
    write_filter("twice.fs", R"("PASSES": [{"TARGET": "sum", "PERSISTENT": true, "FLOAT": true},
{"TARGET": "sum", "PERSISTENT": true, "FLOAT": true}, {}])",
                 R"(void main() {
    vec4 sum_here = IMG_THIS_PIXEL(sum);
    if (PASSINDEX == 0) gl_FragColor = sum_here + 0.0625;
    else if (PASSINDEX == 1) gl_FragColor = 2.0 * sum_here;
    else gl_FragColor = sum_here;
}
)");
    write_text(folder_ / "capture.json", R"({"aftershade": 1, "frames": "in_####.exr"})");
    run(step("twice.fs"),
        {"capture.json", "-o", "out_####.exr", "--output-roles", "display", "--frames", "1-3"});
    // 2 (s + 1/16), from 0.
    for (const auto& [frame, expected] : {std::pair(1, 0.125), {2, 0.375}, {3, 0.875}})
        EXPECT_EQ(read(folder_ / ("out_000" + std::to_string(frame) + ".exr"), "display.").at(0, 0, 0),
                  expected)
            << frame;
}

TEST_F(IsfDialect, KeepsItsBuffersInSavedHistoryAndInChunks) {
    write_filter(
        "trail.fs",
        R"("INPUTS": [{"NAME": "inputImage", "TYPE": "image"}], "PASSES": [{"TARGET": "last", "PERSISTENT": true}, {}])",
        "void main() { vec4 c = IMG_THIS_PIXEL(last); if (PASSINDEX == 0) c = mix(c, vec4(TIME, "
        "isf_FragNormCoord, 1.0), 0.3); gl_FragColor = c; }\n");
    const auto film = [&](const std::string& out, std::vector<std::string> more) {
        more.insert(more.begin(),
                    {"in_####.exr", "-o", out + "_####.exr", "--output-roles", "display", "--no-journal"});
        run(R"({"effect": "view_transform"},)" + step("trail.fs"), more);
    };
    film("whole", {});
    film("part", {"--frames", "1-2", "--history-out", "h"});
    film("part", {"--frames", "3-4", "--history-in", "h"});
    film("chunk", {"--chunk", "2/2", "--warmup", "2"});
    for (const char* frame : {"_0003.exr", "_0004.exr"})
        for (const std::string way : {"part", "chunk"})
            EXPECT_TRUE(
                std::ranges::equal(read(folder_ / ("whole" + std::string(frame)), "display.").floats(),
                                   read(folder_ / (way + frame), "display.").floats()))
                << way << frame;
}

TEST_F(IsfDialect, ImportsPngAndJpegBesideTheFile) {
    fs::create_directories(folder_ / "filters");
    fs::copy_file(fs::path(AFTERSHADE_SOURCE_DIR) / "tests/fuzz/corpus/jpeg/two_halves.jpg",
                  folder_ / "filters/halves.jpg");
    write_filter("x.fs", R"("IMPORTED": {"halves": {"PATH": "halves.jpg"}})",
                 "void main() { gl_FragColor = IMG_NORM_PIXEL(halves, isf_FragNormCoord); }\n");
    const Image image = display(step("x.fs"));
    EXPECT_NEAR(image.at(2, 4, 0), 200 / 255.0, 3 / 255.0);
    EXPECT_NEAR(image.at(13, 4, 2), 180 / 255.0, 3 / 255.0);
}

/// As other hosts, which know no pixel outside of the frame.
TEST_F(IsfDialect, DrawsTheDisplayWindowWhateverTheDataWindow) {
    write_filter("ramp.fs", "",
                 "void main() { gl_FragColor = vec4(isf_FragNormCoord, RENDERSIZE / 64.0); }\n");
    write_filter("blur.fs", kImage,
                 "void main() { gl_FragColor = 0.5 * (IMG_NORM_PIXEL(inputImage, isf_FragNormCoord) + "
                 "IMG_PIXEL(inputImage, gl_FragCoord.xy + vec2(2.0, 1.0))); }\n");
    const Image whole = display(step("ramp.fs") + "," + step("blur.fs"));
    for (const Window data : {Window{-3, -2, kWidth + 4, kHeight + 1}, Window{5, 2, 9, 6}}) {
        Capture capture = make_capture({.width = data.width(), .height = data.height()}, 1);
        capture.header.data_window = data;
        capture.header.display_window = {0, 0, kWidth - 1, kHeight - 1};
        write_capture(capture, folder_ / "other.exr");
        run(step("ramp.fs") + "," + step("blur.fs"),
            {"other.exr", "-o", "other_out.exr", "--output-roles", "display", "--pixel-type", "float"});
        ASSERT_EQ(ExrFile(folder_ / "other_out.exr").parts()[0].data_window, data);
        const Image image = read(folder_ / "other_out.exr", "display.");
        for (int y = 0; y < data.height(); ++y)
            for (int x = 0; x < data.width(); ++x) {
                const int wx = x + data.min_x, wy = y + data.min_y;
                const bool is_inside = wx >= 0 && wy >= 0 && wx < kWidth && wy < kHeight;
                // Both filters read the data window's pixels alone; those of the crop lie in it.
                const bool is_far = wx + 2 <= data.max_x && wy - 1 >= data.min_y;
                for (int c = 0; c < 4; ++c) {
                    if (!is_inside) {
                        EXPECT_EQ(image.at(x, y, c), 0) << wx << " " << wy;
                    } else if (is_far) {
                        EXPECT_NEAR(image.at(x, y, c), whole.at(wx, wy, c), 1e-6) << wx << " " << wy;
                    }
                }
            }
    }
}

}  // namespace
}  // namespace aftershade::test
