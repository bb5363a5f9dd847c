// Captures, outputs, GL and effects that cannot work.
#include <cstdint>
#include <cstring>

#include "framework/batch/process_codes.h"
#include "tests/cli/fault_table.h"
#include "tests/real_captures.h"

namespace aftershade::test {
namespace {

namespace fs = std::filesystem;

void cut(const fs::path& file, double part) {
    fs::resize_file(file, std::uintmax_t(double(fs::file_size(file)) * part));
}

/// Sets the last pixel of both windows of an EXR header.
void claim_size(const fs::path& file, std::int32_t max_x, std::int32_t max_y) {
    std::string bytes = read_text(file);
    for (const std::string name : {"dataWindow", "displayWindow"}) {
        const std::string head = name + std::string("\0box2i\0\x10\0\0\0", 11);
        const std::size_t value = bytes.find(head) + head.size();
        std::memcpy(&bytes[value + 8], &max_x, sizeof max_x);
        std::memcpy(&bytes[value + 12], &max_y, sizeof max_y);
    }
    write_text(file, bytes);
}

void write_rgb_only(const fs::path& file) {
    const Image color(4, 4, 3);
    std::vector<ExrOutputChannel> channels;
    for (const int c : {0, 1, 2}) channels.push_back({std::string(1, "RGB"[c]), PixelType::half, &color, c});
    ExrWriteOptions options;
    options.data_window = options.display_window = {0, 0, 3, 3};
    write_exr(file, channels, options);
}

void write_effect(const Workplace& work, const std::string& shader) {
    fs::create_directories(work / "effects/tint");
    write_text(work / "effects/tint/effect.json",
               R"({ "aftershade": 1, "id": "tint", "version": "1.0.0", "summary": "A tint.",
        "inputs": { "color": { "role": "color" } }, "outputs": { "color": { "role": "color" } },
        "passes": [ { "name": "paint", "shader": "paint.frag", "reads": ["color"],
                        "writes": ["color"] } ] })");
    write_text(work / "effects/tint/paint.frag", shader);
    write_text(work / "tint.json", R"({ "aftershade": 1, "steps": [ { "effect": "tint" } ] })");
}

std::vector<Fault> capture_faults() {
    const ExitCode code = ExitCode::capture;
    const auto damaged = [&](const std::string& what, const std::string& message, auto damage) {
        return Fault{what,
                     {"view.json", "frame.exr", "-o", "out.exr"},
                     code,
                     {"aftershade: error: frame\\.exr: " + message},
                     [damage](const Workplace& work) { damage(work / "frame.exr"); }};
    };
    return {
        {"AMissingFile",
         {"view.json", "nowhere.exr", "-o", "out.exr"},
         code,
         {"aftershade: error: nowhere\\.exr: .*[Nn]o such file.*"}},
        {"AMissingCaptureDocument",
         {"view.json", "nowhere.json", "-o", "out.exr"},
         code,
         {"aftershade: error: nowhere\\.json: no such file"}},
        damaged("AnEmptyFile", "the file is empty", [](const fs::path& file) { write_text(file, ""); }),
        damaged("TextInsteadOfAnImage", "not an OpenEXR file .*",
                [](const fs::path& file) { write_text(file, "hello"); }),
        damaged("AFileCutInItsFirstBytes", ".+", [](const fs::path& file) { fs::resize_file(file, 6); }),
        damaged("AFileCutInItsHeader", ".+", [](const fs::path& file) { fs::resize_file(file, 100); }),
        damaged("AFileCutInItsPixels", "cut off.+", [](const fs::path& file) { cut(file, 0.9); }),
        damaged("AFileCutByOneByte", "cut off.+",
                [](const fs::path& file) { fs::resize_file(file, fs::file_size(file) - 1); }),
        damaged("AHeaderThatClaimsAHugeSize", ".*100000001 x 100000001 px.*16384.*",
                [](const fs::path& file) { claim_size(file, 100'000'000, 100'000'000); }),
        damaged("AHeaderWhoseSizeOverflows", ".+",
                [](const fs::path& file) { claim_size(file, INT32_MAX, INT32_MAX); }),
        damaged("AHeaderWithAnInvertedWindow", ".+ holds no pixel.*",
                [](const fs::path& file) { claim_size(file, -5, -5); }),
        damaged("APipe", "is not a regular file.*",
                [](const fs::path& file) {
                    fs::remove(file);
                    mkfifo(file.c_str(), 0600);
                }),
        damaged("AFolderInsteadOfAFile", "(is a folder, not an OpenEXR file|holds no numbered \\.exr files)",
                [](const fs::path& file) {
                    fs::remove(file);
                    fs::create_directory(file);
                }),
        {"ASideAboveMaxSize",
         {"view.json", "frame.exr", "-o", "out.exr", "--max-size", "15"},
         code,
         {"aftershade: error: frame\\.exr: .*16 x 9 px, the limit is 15 px a side.*"}},
        {"MoreBytesThanMaxImageBytes",
         {"view.json", "frame.exr", "-o", "out.exr", "--max-image-bytes", "1000"},
         code,
         {"aftershade: error: frame\\.exr: .*1000.*"}},
        {"ARoleThatTheFileLacks",
         {"bokeh.json", "rgb.exr", "-o", "out.exr"},
         code,
         {"aftershade: error: rgb\\.exr: step 'bokeh' \\(effect bokeh\\) needs the role 'depth', which the "
          "profile 'native' "
          "does not find among the channels B, G, R \\(--role depth=FILE reads it from a file of its own; "
          ".*"},
         [](const Workplace& work) { write_rgb_only(work / "rgb.exr"); },
         true},
        {"ARoleThatNeitherTheCaptureNorTheLookHas",
         {"view.json", "rgb.exr", "-o", "out.exr", "--output-roles", "velocity"},
         code,
         {"aftershade: error: rgb\\.exr: the role 'velocity', requested in the output, .*"},
         [](const Workplace& work) { write_rgb_only(work / "rgb.exr"); }},
        {"APatternThatMatchesNothing",
         {"view.json", "none_####.exr", "-o", "out_####.exr"},
         code,
         {"aftershade: error: none_####\\.exr: no file fits the pattern none_####\\.exr"}},
        {"APatternInAMissingFolder",
         {"view.json", "none/seq_####.exr", "-o", "out_####.exr"},
         code,
         {"aftershade: error: none/seq_####\\.exr: no file fits the pattern none/seq_####\\.exr"}},
        {"EveryFrameOfASequenceDamaged",
         {"view.json", "seq_####.exr", "-o", "out_####.exr"},
         code,
         {"aftershade: error: seq_0001\\.exr: .+", "aftershade: error: seq_0002\\.exr: .+",
          "aftershade: error: seq_0003\\.exr: .+"},
         [](const Workplace& work) {
             for (const char* name : {"seq_0001.exr", "seq_0002.exr", "seq_0003.exr"}) cut(work / name, 0.5);
         }},
    };
}

std::vector<Fault> output_faults() {
    const ExitCode code = ExitCode::output;
    return {
        {"AFolderInTheOutputsPlace",
         {"view.json", "frame.exr", "-o", "out.exr"},
         code,
         {"aftershade: error: out\\.exr: is a folder, a file name is expected"},
         [](const Workplace& work) { fs::create_directory(work / "out.exr"); }},
        {"AFileInTheOutputFoldersPlace",
         {"view.json", "frame.exr", "-o", "view.json/out.exr"},
         code,
         {"aftershade: error: view\\.json/out\\.exr: 'view\\.json' is a file, a folder is expected"}},
    };
}

std::vector<Fault> gl_and_effect_faults() {
    const std::string start = "#version 450 core\n#include <pass>\n";
    const auto shader = [&](const std::string& what, const std::string& text,
                            std::vector<std::string> messages) {
        return Fault{what,
                     {"tint.json", "frame.exr", "-o", "out.exr", "--effect-path", "effects"},
                     ExitCode::effect,
                     std::move(messages),
                     [text](const Workplace& work) { write_effect(work, text); }};
    };
    return {
        {"NoUsableGl",
         {"view.json", "frame.exr", "-o", "out.exr"},
         ExitCode::gl,
         {"aftershade: error: no usable GL",
          "  egl-software: libEGL\\.so\\.1 is there, but the loader refuses it: .*",
          "  osmesa: libOSMesa\\.so\\.8 is there, but the loader refuses it: .*"},
         {},
         true},
        {"NoBackendAtAll",
         {"view.json", "frame.exr", "-o", "out.exr", "--backend", "auto"},
         ExitCode::gl,
         {"aftershade: error: no usable GL", "  egl: libEGL\\.so\\.1 is there, .*",
          "  egl-software: libEGL\\.so\\.1 is there, .*", "  osmesa: libOSMesa\\.so\\.8 is there, .*"},
         {},
         true},
        shader(
            "AnUndeclaredNameInAShader", start + "void main() {\n    out_color = parm.tint;\n}\n",
            {"effects/tint/paint\\.frag:4:[0-9]+: error: .*parm.*undeclared   \\[pass paint, llvmpipe.*\\]",
             "effects/tint/paint\\.frag:4:[0-9]+: error: type mismatch   \\[pass paint, llvmpipe.*\\]"}),
        shader("ASyntaxFaultInAShader", start + "void main() {\n    out_color = vec4(1.0\n}\n",
               {"effects/tint/paint\\.frag:5:[0-9]+: error: syntax error.*   \\[pass paint, llvmpipe.*\\]"}),
        shader("AShaderWithoutItsHead", "void main() {}\n",
               {"effects/tint/paint\\.frag:1:1: error: a shader begins with '#version 450 core' and then has "
                ".*"}),
        shader("AShaderThatIncludesFromElsewhere", start + "#include \"../secret.glsl\"\nvoid main() {}\n",
               {"effects/tint/paint\\.frag:3:1: error: '\\.\\./secret\\.glsl' is not a plain file name"}),
        shader("AShaderWhoseIncludeIsMissing", start + "#include <none.glsl>\nvoid main() {}\n",
               {"effects/tint/paint\\.frag:3:1: error: cannot read .*none\\.glsl"}),
    };
}

class CaptureFault : public FaultTest {};
TEST_P(CaptureFault, IsToldAndLeavesNothingBehind) {
    check();
}
INSTANTIATE_TEST_SUITE_P(Of, CaptureFault, testing::ValuesIn(capture_faults()), fault_name);

class OutputFault : public FaultTest {};
TEST_P(OutputFault, IsToldAndLeavesNothingBehind) {
    check();
}
INSTANTIATE_TEST_SUITE_P(Of, OutputFault, testing::ValuesIn(output_faults()), fault_name);

class GlOrEffectFault : public FaultTest {};
TEST_P(GlOrEffectFault, IsToldAndLeavesNothingBehind) {
    check();
}
INSTANTIATE_TEST_SUITE_P(Of, GlOrEffectFault, testing::ValuesIn(gl_and_effect_faults()), fault_name);

TEST(CaptureFaults, ADeepFileThatIsCutOffIsRefused) {
    AFTERSHADE_REQUIRE_CAPTURE(deep, "exr-suite/v2/LowResLeftView/Trunks.exr");
    const Workplace work;
    write_text(work / "cut.exr", read_text(*deep).substr(0, 400'000));
    const auto before = contents(work.path());
    const CommandResult result =
        run_aftershade({"run", "view.json", "cut.exr", "-o", "out.exr"}, work.path());
    EXPECT_EQ(result.exit_code, int(ExitCode::capture));
    EXPECT_TRUE(
        std::regex_search(result.err, std::regex("aftershade: error: .*cut\\.exr: cut off or damaged")))
        << result.err;
    EXPECT_EQ(contents(work.path()), before);
}

TEST(OutputFaults, AFullDiskKeepsTheOlderFileWhole) {
    const Workplace work;
    SyntheticScene scene{.width = 256, .height = 256};
    Capture noise = make_capture(scene);
    std::uint32_t state = 1;  // noise, so that compression does not make the file small
    for (float& value : noise.images.at("color").floats())
        value = float((state = state * 1664525u + 1013904223u) >> 16);
    write_capture(noise, work / "noise.exr");
    write_text(work / "out.exr", "the older file");
    const auto before = contents(work.path());
    // A limit on the size of files stands for a disk without space: both make write() fail.
    const CommandResult result =
        Command({"/bin/sh", "-c", "ulimit -f 16; exec \"$0\" \"$@\"", AFTERSHADE_EXECUTABLE, "run",
                 "view.json", "noise.exr", "-o", "out.exr", "--progress", "none", "--backend", "software"},
                work.path())
            .wait();
    EXPECT_EQ(result.exit_code, int(ExitCode::output));
    EXPECT_TRUE(std::regex_search(result.err, std::regex("aftershade: error: out\\.exr: .*File too large")))
        << result.err;
    EXPECT_EQ(contents(work.path()), before);
}

TEST(PartialSequence, WritesTheSoundFramesAndExitsWithOne) {
    const Workplace work;
    cut(work / "seq_0002.exr", 0.9);
    const CommandResult result = run_aftershade(
        {"run", "view.json", "seq_####.exr", "-o", "out_####.exr", "--progress", "none"}, work.path());
    EXPECT_EQ(result.exit_code, int(ExitCode::partial)) << result.err;
    EXPECT_EQ(result.out, "out_0001.exr\nout_0003.exr\n");
    const auto lines = told(result);
    ASSERT_EQ(lines.size(), 1u) << result.err;
    EXPECT_TRUE(std::regex_match(lines[0], std::regex("aftershade: error: seq_0002\\.exr: cut off.+")))
        << lines[0];
    EXPECT_FALSE(fs::exists(work / "out_0002.exr"));
    EXPECT_EQ(read_text(work / "out_0001.exr").size(), read_text(work / "out_0003.exr").size());
}

TEST(PartialSequence, GoesOnAfterAMissingFrameOfItsRange) {
    const Workplace work;
    fs::remove(work / "seq_0001.exr");
    write_text(work / "capture.json", R"({ "aftershade": 1, "frames": "seq_####.exr", "range": "1-3" })");
    const CommandResult result = run_aftershade(
        {"run", "view.json", "capture.json", "-o", "out_####.exr", "--progress", "none"}, work.path());
    EXPECT_EQ(result.exit_code, int(ExitCode::partial)) << result.err;
    EXPECT_EQ(result.out, "out_0002.exr\nout_0003.exr\n");
    EXPECT_NE(result.err.find("seq_0001.exr: "), std::string::npos) << result.err;
}

class Interrupted : public testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(By, Interrupted, testing::Values(SIGINT, SIGTERM),
                         [](const auto& signal) { return signal.param == SIGINT ? "SIGINT" : "SIGTERM"; });

TEST_P(Interrupted, LeavesWholeFilesOnly) {
    const Workplace work;
    SyntheticScene scene{.width = 192, .height = 108, .background_depth_m = 5};
    write_capture(make_capture(scene), work / "many_0001.exr");
    constexpr int kFrames = 300;
    for (int frame = 2; frame <= kFrames; ++frame)
        fs::create_hard_link(work / "many_0001.exr",
                             FramePattern((work / "many_####.exr").string()).path(frame));
    const auto before = contents(work.path());
    Command command(
        aftershade_words({"run", "bokeh.json", "many_####.exr", "-o", "out_####.exr", "--progress", "none"}),
        work.path(), {{"AFTERSHADE_BACKEND", "software"}});
    ASSERT_TRUE(command.wait_for_lines(2));
    command.send(GetParam());
    const CommandResult result = command.wait();
    EXPECT_EQ(result.exit_code, int(ExitCode::interrupted)) << result.err;
    const auto printed = lines_of_text(result.out);
    EXPECT_GE(printed.size(), 2u);
    EXPECT_LT(printed.size(), std::size_t(kFrames));
    EXPECT_EQ(contents(work / ".aftershade").size(), 1u) << "the journal, and no lock";
    fs::remove_all(work / ".aftershade");
    EXPECT_EQ(contents(work.path()).size(), before.size() + printed.size());
    const std::vector<std::string> color{"R", "G", "B", "A"};
    for (const std::string& path : printed)
        EXPECT_NO_THROW(ExrFile(work / path).read_floats(0, color)) << path;
}

}  // namespace
}  // namespace aftershade::test
