// ISF files as other hosts take them: lenient JSON, corners and coordinates of a vertex shader, cube maps.
#include "framework/file/png_file.h"
#include "tests/cli/isf_files.h"

namespace aftershade::test {
namespace {

class IsfHosts : public IsfFiles {
protected:
    std::vector<float> pixel(const std::string& steps, int x, int y) {
        const Image image = display(steps);
        return {image.at(x, y, 0), image.at(x, y, 1), image.at(x, y, 2), image.at(x, y, 3)};
    }
    /// The first pixel of a file with these members.
    std::vector<float> first(const std::string& members, const std::string& shader) {
        write_filter("x.fs", members, shader);
        return pixel(step("x.fs"), 0, 0);
    }
};

TEST_F(IsfHosts, TakeACommaBeforeABracketAndTheLastOfTwoEqualKeys) {
    write_filter("x.fs", R"("INPUTS": [
{"NAME": "a", "TYPE": "float", "DEFAULT": 0.5, "DEFAULT": 0.25,},  // , ]
{"NAME": "b", "TYPE": "color", "DEFAULT": [0.125, 0, 0, 1 ,
], "LABEL": ",]"},
],
"CREDIT": "a \",}",)",
                 "void main() { gl_FragColor = vec4(a, b.rgb); }\n");
    EXPECT_EQ(pixel(step("x.fs"), 0, 0), (std::vector<float>{0.25f, 0.125f, 0.0f, 0.0f}));
    const CommandResult checked = run_aftershade({"check", "filters/x.fs"}, folder_.path());
    EXPECT_NE((checked.out + checked.err).find("x.fs:3:48: warning: the key 'DEFAULT' occurs twice"),
              std::string::npos)
        << checked.out << checked.err;
}

TEST_F(IsfHosts, TakeLinesOfWindowsAndByteOrderMarksAndCommentsBeforeTheJson) {
    write_text(folder_ / "filters/x.fs",
               "\xEF\xBB\xBF// see /* there\r\n#version 120\r\n/*{\r\n \"INPUTS\": "
               "[],\r\n}*/\r\n\xEF\xBB\xBF#define HALF \\\r\n"
               "  vec4(0.5)\r\nvoid main() {\r\n gl_FragColor = HALF;\r\n}\r\n");
    EXPECT_EQ(pixel(step("x.fs"), 0, 0), std::vector<float>(4, 0.5f));
}

TEST_F(IsfHosts, TakeNamesThatOlderGlslKeepsApartAndConstantsOfAFrame) {
    EXPECT_EQ(first(R"("PASSES": [{"TARGET": "blur"}, {}])", R"(float k = 0.25;
float k(float x) { return 2.0 * x; }
vec4 blur(float x) { return vec4(x); }
const float aspect = RENDERSIZE.x / RENDERSIZE.y, half_aspect = 0.5 * aspect;
void main() { gl_FragColor = PASSINDEX == 0 ? blur(k(k)) : vec4(IMG_THIS_PIXEL(blur).r, half_aspect / 4.0, 0.0, 1.0); }
)"),
              (std::vector<float>{128 / 255.0f, 0.25f, 0.0f, 1.0f}));
}

TEST_F(IsfHosts, TakeNamesThatBeginLikeThoseOfIsf) {
    EXPECT_EQ(first(R"("INPUTS": [{"NAME": "isf_x", "TYPE": "float", "DEFAULT": 0.5}],
"PASSES": [{"TARGET": "isf", "FLOAT": true}, {"TARGET": "isf_size", "FLOAT": true}, {}])",
                    "void main() { gl_FragColor = PASSINDEX == 0 ? vec4(isf_x) : PASSINDEX == 1 ? 0.5 * "
                    "IMG_THIS_PIXEL(isf) : IMG_NORM_PIXEL(isf_size, isf_FragNormCoord); }\n"),
              std::vector<float>(4, 0.25f));
}

TEST_F(IsfHosts, TakeTypesAndValuesAsFilesWriteThem) {
    EXPECT_EQ(first(R"("CREDIT": ["you", "me"], "DESCRIPTION": 3, "INPUTS": [
{"NAME": "a", "TYPE": "FLOAT", "DEFAULT": "0.5", "MIN": "low", "LABEL": 7},
{"NAME": "p", "TYPE": "point2d", "DEFAULT": ["0.25", 0.5, 0]},
{"NAME": "l", "TYPE": "long", "LABELS": ["one", "two", "three"], "DEFAULT": "three"}])",
                    "void main() { gl_FragColor = vec4(a, p, float(l) / 4.0); }\n"),
              (std::vector<float>{0.5f, 0.25f, 0.5f, 0.5f}));
}

TEST_F(IsfHosts, HaveAnOutputThatNoFileDeclares) {
    EXPECT_EQ(first("", "void main() { isf_FragColor = vec4(isf_FragCoord.xy / 64.0, 0.0, 1.0); }\n"),
              (std::vector<float>{0.5f / 64, 7.5f / 64, 0, 1}));
}

TEST_F(IsfHosts, TakeTheirAliasesAsNamesOfParametersLocalsAndMembers) {
    EXPECT_EQ(first("", R"(struct Part { vec4 isf_FragColor; };
void mainImage(out vec4 isf_FragColor, in vec2 isf_FragCoord) { isf_FragColor = vec4(isf_FragCoord, 0.0, 1.0); }
#ifdef ABSENT
vec4 half_of(Part part) {
#else
vec4 half_of(const Part part) {
#endif
    vec4 isf_FragColor = 0.5 * part.isf_FragColor;
    return isf_FragColor;
}
void main() {
    Part part;
    mainImage(part.isf_FragColor, gl_FragCoord.xy / 32.0);
    gl_FragColor = half_of(part);
}
)"),
              (std::vector<float>{0.5f / 64, 7.5f / 64, 0, 0.5f}));
}

TEST_F(IsfHosts, KeepConstantsThatOnlyCompare) {
    EXPECT_EQ(first("", R"(const bool late = TIME >= 1.0;
const int kSize = 3 >= 2 ? 4 : 2;
const float parts[2] = float[2](RENDERSIZE.x, 0.5), part = parts[1];
float all[kSize];
void main() { all[3] = late ? 1.0 : part; gl_FragColor = vec4(all[3]); }
)"),
              std::vector<float>(4, 0.5f));
}

TEST_F(IsfHosts, LetAVaryingBeThatNothingReads) {
    EXPECT_EQ(first("",
                    "#define N 2\nvarying vec2 surfacePosition, other[N];\n"
                    "void main() { gl_FragColor = vec4(0.25 * float(N)); }\n"),
              std::vector<float>(4, 0.5f));
}

TEST_F(IsfHosts, LeaveNothingWhereAShaderDiscards) {
    write_filter("x.fs", R"("PASSES": [{"TARGET": "a"}, {}])",
                 R"(float part(float x) { if (x < 0.25) discard; return x; }
void main() {
    for (;;) {
        if (isf_FragNormCoord.x > 0.75) discard;
        if (isf_FragNormCoord.x <= 0.75) break;
    }
    gl_FragColor = PASSINDEX == 0 ? vec4(part(isf_FragNormCoord.x)) : IMG_THIS_PIXEL(a);
}
)");
    const Image image = display(step("x.fs"));
    for (int x = 0; x < kWidth; ++x) {
        const float at = (float(x) + 0.5f) / kWidth;
        EXPECT_NEAR(image.at(x, 3, 0), at < 0.25f || at > 0.75f ? 0.0f : at, 0.5 / 255) << x;
    }
}

/// The vertex shader makes the picture half as large and swaps its axes.
TEST_F(IsfHosts, DrawWhereAVertexShaderPlacesItsCorners) {
    write_filter("ramp.fs", "", kRamp);
    write_filter("x.fs", kImage,
                 "void main() { gl_FragColor = vec4(isf_FragNormCoord, IMG_THIS_PIXEL(inputImage).ra); }\n");
    write_text(folder_ / "filters/x.vs",
               "void main() {\n isf_vertShaderInit();\n gl_Position.xy = 0.5 * gl_Position.xy + vec2(0.5);\n"
               " isf_FragNormCoord.xy = isf_FragNormCoord.yx;\n}\n");
    const Image image = display(step("ramp.fs") + "," + step("x.fs"));
    for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x) {
            if (x < kWidth / 2 || y >= kHeight / 2) {
                for (int c = 0; c < 4; ++c) EXPECT_EQ(image.at(x, y, c), 0) << x << " " << y;
                continue;
            }
            const float right = (float(x - kWidth / 2) + 0.5f) / (kWidth / 2);
            const float up = (float(kHeight / 2 - 1 - y) + 0.5f) / (kHeight / 2);
            EXPECT_NEAR(image.at(x, y, 0), up, 1e-5) << x << " " << y;
            EXPECT_NEAR(image.at(x, y, 1), right, 1e-5) << x << " " << y;
            EXPECT_NEAR(image.at(x, y, 2), up, 1e-5) << x << " " << y;
            EXPECT_EQ(image.at(x, y, 3), 1) << x << " " << y;
        }
}

TEST_F(IsfHosts, FindCoordinatesThatAVertexShaderSetsInEveryWay) {
    for (const std::string turn :
         {"void turn(inout vec2 at) { at = at.yx; }\n", "#define turn(at) at = at.yx\n"})
        for (const std::string call : {"turn(isf_FragNormCoord);", "TURN", "isf_FragNormCoord.x++;"}) {
            write_filter("x.fs", "",
                         "void main() { gl_FragColor = vec4(isf_FragNormCoord / 2.0, 0.0, 1.0); }\n");
            const std::string macro = call == "TURN" ? "#define TURN turn(isf_FragNormCoord);\n" : "";
            write_text(folder_ / "filters/x.vs",
                       turn + macro + "void main() {\n isf_vertShaderInit();\n " + call + "\n}\n");
            const bool is_turned = call != "isf_FragNormCoord.x++;";
            const std::vector<float> found = pixel(step("x.fs"), 3, 5);
            EXPECT_NEAR(found[0], is_turned ? 2.5 / kHeight / 2 : (1 + 3.5 / kWidth) / 2, 1e-5)
                << turn << call;
            EXPECT_NEAR(found[1], is_turned ? 3.5 / kWidth / 2 : 2.5 / kHeight / 2, 1e-5) << turn << call;
        }
}

/// Red: the face; green and blue: right and down on it.
TEST_F(IsfHosts, SampleCubeMaps) {
    std::string paths;
    for (int face = 0; face < 6; ++face) {
        Image picture(4, 4, 3);
        for (int y = 0; y < 4; ++y)
            for (int x = 0; x < 4; ++x) {
                picture.at(x, y, 0) = float(face) / 5;
                picture.at(x, y, 1) = float(x) / 3;
                picture.at(x, y, 2) = float(y) / 3;
            }
        const std::string name = "face" + std::to_string(face) + ".png";
        write_png(folder_ / "filters" / name, picture);
        paths += std::string(face > 0 ? ", " : "") + "\"" + name + "\"";
    }
    const std::string members = R"("IMPORTED": {"sky": {"TYPE": "cube", "PATH": [)" + paths + "]}}";
    // OpenGL 4.6, table 8.19: a direction whose major axis is 1, and where it meets the face.
    struct Case {
        std::string at;
        int face;
        double right, down;
    };
    for (const Case& c : std::vector<Case>{{"1.0, -0.25, 0.25", 0, -0.25, 0.25},
                                           {"-1.0, 0.25, 0.25", 1, 0.25, -0.25},
                                           {"0.25, 1.0, -0.25", 2, 0.25, -0.25},
                                           {"0.25, -1.0, -0.25", 3, 0.25, 0.25},
                                           {"-0.25, 0.25, 1.0", 4, -0.25, -0.25},
                                           {"-0.25, 0.25, -1.0", 5, 0.25, -0.25}})
        for (const std::string read : {"textureCube(sky, d)", "texture(sky, d)", "textureLod(sky, d, 0.0)",
                                       "textureCube(sky, d, 1.0)", "textureCubeLod(sky, d, 0.0)"}) {
            const std::vector<float> found =
                first(members, "uniform samplerCube sky;\nvoid main() { vec3 d = 2.0 * vec3(" + c.at +
                                   "); gl_FragColor = " + read + "; }\n");
            EXPECT_NEAR(found[0], c.face / 5.0, 1e-5) << c.at;
            // 4 texels a side, from -0.75 to 0.75.
            EXPECT_NEAR(found[1], 0.5 + c.right / 1.5, 1e-2) << c.at;
            EXPECT_NEAR(found[2], 0.5 + c.down / 1.5, 1e-2) << c.at;
        }
}

}  // namespace
}  // namespace aftershade::test
