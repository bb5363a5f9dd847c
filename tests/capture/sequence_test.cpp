#include "framework/capture/sequence.h"

#include "tests/documents.h"
#include "tests/file/image_files.h"

namespace aftershade {
namespace {

using test::capture_error;
using test::Lines;
using test::TemporaryFolder;
using test::write_text;
using Frames = std::vector<int>;

Sequence opened(const std::string& argument) {
    Diagnostics diagnostics;
    const auto sequence = open_sequence(argument, diagnostics);
    EXPECT_EQ(test::lines_of(diagnostics), Lines{}) << argument;
    return sequence.value_or(Sequence{});
}

/// The faults of a capture.json, without their folder.
Lines faults_of_capture(const std::string& text) {
    const TemporaryFolder folder;
    write_text(folder / "capture.json", text);
    Diagnostics diagnostics;
    EXPECT_FALSE(open_sequence((folder / "capture.json").string(), diagnostics).has_value());
    Lines lines = test::lines_of(diagnostics);
    for (std::string& line : lines) line = line.substr(folder.path().string().size() + 1);
    return lines;
}

TEST(Sequence, OfACaptureDocumentHasAllThatItSays) {
    const TemporaryFolder folder;
    write_text(folder / "capture.json", R"({ "aftershade": 1, "$schema": "x", // a comment
        "frames": "gbuffer_####.exr", "range": "3-4,8", "fps": 23.976, "profile": "blender",
        "camera": { "focal_length": "5 cm", "sensor_width": 36, "rotation": "0.5 turn" }, "cuts": [4, 8] })");
    const Sequence sequence = opened((folder / "capture.json").string());
    EXPECT_EQ(sequence.frames, (Frames{3, 4, 8}));
    EXPECT_EQ(sequence.path_of(3), folder / "gbuffer_0003.exr");
    EXPECT_EQ(sequence.fps, 23.976);
    EXPECT_EQ(sequence.profile, "blender");
    EXPECT_EQ(sequence.cuts, (Frames{4, 8}));
    EXPECT_EQ(sequence.camera.get("focal_length"), 50.0);
    EXPECT_EQ(sequence.camera.get("sensor_width"), 36.0);
    EXPECT_EQ(sequence.camera.get("rotation"), 180.0);
    EXPECT_EQ(sequence.camera.get("focus_distance"), std::nullopt);
}

TEST(Sequence, OfTheShippedCaptureIsItsTwoFrames) {
    const Sequence sequence = opened(AFTERSHADE_SOURCE_DIR "/scenes/suzanne/capture.json");
    EXPECT_EQ(sequence.frames, (Frames{3, 4}));
    EXPECT_TRUE(std::filesystem::exists(sequence.path_of(3)));
    EXPECT_TRUE(std::filesystem::exists(sequence.path_of(4)));
    EXPECT_EQ(sequence.camera.get("focal_length"), 50.0);
}

TEST(Sequence, WithoutARangeIsTheFilesThatThereAre) {
    const TemporaryFolder folder;
    for (const char* name :
         {"f_0010.exr", "f_0002.exr", "f_-001.exr", "f_2.exr", "f_0003.png", "g_0001.exr", "f_.exr"})
        write_text(folder / name, "");
    write_text(folder / "capture.json", R"({"aftershade": 1, "frames": "f_####.exr"})");
    const Frames expected = {-1, 2, 10};
    EXPECT_EQ(opened((folder / "capture.json").string()).frames, expected);
    EXPECT_EQ(opened((folder / "f_####.exr").string()).frames, expected);
    EXPECT_EQ(opened((folder / "f_%04d.exr").string()).frames, expected);
    EXPECT_EQ(opened(folder.path().string() + "//f_####.exr").frames, expected)
        << "two slashes name the same folder";
    EXPECT_EQ(opened(folder.path().string() + "/./f_####.exr").frames, expected);
}

TEST(Sequence, OfABareFileIsNumberedByItsName) {
    const TemporaryFolder folder;
    for (const char* name : {"v2_gbuffer_0004.exr", "still.exr"}) write_text(folder / name, "");
    const Sequence numbered = opened((folder / "v2_gbuffer_0004.exr").string());
    EXPECT_EQ(numbered.frames, Frames{4});
    EXPECT_EQ(numbered.path_of(4), folder / "v2_gbuffer_0004.exr");
    EXPECT_EQ(numbered.profile, "auto");
    const Sequence still = opened((folder / "still.exr").string());
    EXPECT_EQ(still.frames, Frames{1});
    EXPECT_EQ(still.path_of(1), folder / "still.exr");
}

TEST(Sequence, OfAFileWithMarksInItsNameIsThatFile) {
    for (const char* name : {"final#2.exr", "shot@home.exr", "50%d.exr"}) {
        const TemporaryFolder folder;
        write_text(folder / name, "");
        const Sequence sequence = opened((folder / name).string());
        ASSERT_EQ(sequence.frames.size(), 1u) << name;
        EXPECT_EQ(sequence.path_of(sequence.frames[0]), folder / name);
    }
}

TEST(Sequence, IsItsNumbersHoweverTheyArePadded) {
    struct Case {
        std::vector<const char*> names;
        Frames frames;
    };
    for (const Case& c :
         {Case{{"a.998.exr", "a.999.exr", "a.1000.exr", "a.1001.exr"}, {998, 999, 1000, 1001}},
          Case{{"a.9998.exr", "a.9999.exr", "a.10000.exr"}, {9998, 9999, 10000}},
          Case{{"a.-0001.exr", "a.0000.exr", "a.0001.exr"}, {-1, 0, 1}},
          Case{{"a.8.exr", "a.09.exr", "a.0010.exr"}, {8, 9, 10}}}) {
        const TemporaryFolder folder;
        for (const char* name : c.names) write_text(folder / name, "");
        write_text(folder / "b.1.exr", "");
        for (const char* pattern : {"", "a.####.exr", "a.%d.exr", "a.@.exr", "a.##.exr"}) {
            Diagnostics said;  // of b.1.exr, where the folder is named
            const Sequence sequence = open_sequence((folder / pattern).string(), said).value_or(Sequence{});
            EXPECT_EQ(said.all().size(), *pattern == '\0' ? 1u : 0u) << pattern;
            EXPECT_EQ(sequence.frames, c.frames) << pattern;
            for (std::size_t i = 0; i < c.frames.size(); ++i)
                EXPECT_EQ(sequence.path_of(c.frames[i]).filename(), c.names[i]) << pattern;
        }
    }
}

TEST(Sequence, OfAFolderTakesExtensionsInCapitals) {
    const TemporaryFolder folder;
    for (const char* name : {"A_0001.EXR", "A_0002.EXR"}) write_text(folder / name, "");
    EXPECT_EQ(opened(folder.path().string()).path_of(2), folder / "A_0002.EXR");
}

TEST(Sequence, IsItsNumbersInWhicheverCaseTheExtensionIs) {
    const TemporaryFolder folder;
    for (const char* name : {"f_0001.exr", "f_0002.EXR", "f_0003.Exr", "F_0004.exr", "f_0005.png"})
        write_text(folder / name, "");
    const Sequence sequence = opened((folder / "f_####.exr").string());
    EXPECT_EQ(sequence.frames, (Frames{1, 2, 3}));
    EXPECT_EQ(sequence.path_of(2), folder / "f_0002.EXR");
    EXPECT_EQ(sequence.path_of(3), folder / "f_0003.Exr");
    std::filesystem::remove(folder / "F_0004.exr");
    EXPECT_EQ(opened(folder.path().string()).frames, (Frames{1, 2, 3}));
    const std::string message = capture_error([&] { opened((folder / "f_0002.exr").string()); });
    EXPECT_NE(message.find("no such file (there is f_0002.EXR)"), std::string::npos) << message;
    write_text(folder / "f_0002.exr", "");
    EXPECT_EQ(opened((folder / "f_####.exr").string()).path_of(2), folder / "f_0002.exr");
    const std::string both = capture_error([&] { opened(folder.path().string()); });
    EXPECT_NE(both.find("frame 2 is both"), std::string::npos) << both;
}

TEST(Sequence, OfAFolderWithFilesOfAnotherSaysWhichIsRead) {
    const TemporaryFolder folder;
    for (const char* name : {"shot_v1_0001.exr", "shot_v1_0002.exr", "shot_v2_0001.exr", "notes.exr"})
        write_text(folder / name, "");
    Diagnostics diagnostics;
    const auto sequence = open_sequence(folder.path().string(), diagnostics);
    ASSERT_TRUE(sequence);
    EXPECT_EQ(sequence->frames, (std::vector<int>{1, 2}));
    EXPECT_EQ(test::lines_of(diagnostics),
              Lines{folder.path().string() + ": warning: only shot_v1_####.exr of the folder is read, not "
                                             "shot_v2_####.exr (name a pattern to choose)"});
    std::filesystem::remove(folder / "shot_v2_0001.exr");
    Diagnostics none;
    open_sequence(folder.path().string(), none);
    EXPECT_TRUE(none.all().empty());
}

TEST(Sequence, RefusesTwoFilesOfOneNumberUnlessThePatternSaysWhich) {
    const TemporaryFolder folder;
    for (const char* name : {"f_2.exr", "f_02.exr", "f_3.exr"}) write_text(folder / name, "");
    const auto fault = [&](const char* pattern) {
        return capture_error([&] {
            Diagnostics diagnostics;
            open_sequence((folder / pattern).string(), diagnostics);
        });
    };
    const std::string both =
        "frame 2 is both " + (folder / "f_02.exr").string() + " and " + (folder / "f_2.exr").string();
    EXPECT_TRUE(fault("f_####.exr").starts_with(both)) << fault("f_####.exr");
    EXPECT_TRUE(fault("").starts_with("frame 2 is both ")) << fault("");
    EXPECT_EQ(opened((folder / "f_##.exr").string()).path_of(2), folder / "f_02.exr");
    EXPECT_EQ(opened((folder / "f_%d.exr").string()).path_of(2), folder / "f_2.exr");
}

TEST(Sequence, NoneOfWhoseFilesIsThereIsRefusedAtOnce) {
    const TemporaryFolder folder;
    for (const char* name : {"f_0001.exr", "f_0002.exr"}) write_text(folder / name, "");
    Sequence sequence = opened((folder / "f_####.exr").string());
    require_some_file(sequence);
    sequence.frames = {2, 3};
    require_some_file(sequence);
    sequence.frames.clear();
    for (int frame = 1'000; frame < 1'001'000; ++frame) sequence.frames.push_back(frame);
    const std::string fault = capture_error([&] { require_some_file(sequence); });
    EXPECT_NE(fault.find("no file of the frames 1000-1000999 is there; there are 1-2"), std::string::npos)
        << fault;
}

TEST(Sequence, ThatIsNotThereIsACaptureError) {
    const TemporaryFolder folder;
    Diagnostics diagnostics;
    const auto error = [&](const std::string& name) {
        const std::string argument = (folder / name).string();
        const std::string message = capture_error([&] { open_sequence(argument, diagnostics); });
        EXPECT_TRUE(message.starts_with(argument + ": ")) << message;
        return message.substr(std::min(message.size(), argument.size() + 2));
    };
    EXPECT_EQ(error("none.json"), "no such file");
    EXPECT_EQ(error("none_0001.exr"), "no such file");
    EXPECT_EQ(error("f_####.exr"), "no file fits the pattern " + (folder / "f_####.exr").string());
    EXPECT_EQ(error("none/f_####.exr"), "no file fits the pattern " + (folder / "none/f_####.exr").string());
    EXPECT_EQ(error("f_@.exr"), "no file fits the pattern " + (folder / "f_@.exr").string());
}

TEST(CaptureDocument, ListsAllItsFaults) {
    const Lines expected = {
        "capture.json:2:15: error: document version 2 is not known; this program reads version 1",
        "capture.json:3:11: error: '1-5x0' is not a frame range such as \"1-100x2,120\"",
        "capture.json:3:28: error: 'fps' must be above 0, not 0",
        "capture.json:5:3: error: camera.focal_length: '50 deg' cannot be converted to mm; write 'um', 'mm', "
        "'cm', 'm', "
        "'km', 'in' or 'ft'",
        "capture.json:6:18: error: camera.f_number: 0 is below the minimum 0.01",
        "capture.json:6:21: error: the camera has no key 'focus'; did you mean 'focus_distance'?",
        "capture.json:7:14: error: 'cuts' holds integers, not a string",
        "capture.json:8:3: error: the capture has no key 'profil'; did you mean 'profile'?",
    };
    EXPECT_EQ(faults_of_capture("{\n"
                                "\"aftershade\": 2, \"frames\": \"f_####.exr\",\n"
                                "\"range\" : \"1-5x0\", \"fps\" : 0,\n"
                                "\"camera\": { \"focal_length\":\n"
                                "  \"50 deg\",\n"
                                "     \"f_number\": 0, \"focus\": 3 },\n"
                                "\"cuts\": [ 1, \"2\" ],\n"
                                "  \"profil\": \"blender\" }"),
              expected);
}

TEST(CaptureDocument, RefusesDecodingsThatMakeAllValuesOne) {
    const auto faults_with = [](const std::string& role, const std::string& keys) {
        const Lines lines = faults_of_capture(
            R"({"aftershade": 1, "frames": "a.exr", "channels": {")" + role + R"(": {"channels": [)" +
            (role == "depth" ? R"("Z")" : R"("u", "v")") + "], " + keys + "}}}");
        return lines.size() == 1 ? lines[0] : std::to_string(lines.size());
    };
    EXPECT_NE(faults_with("depth", R"("scale": 0)").find("'scale' of 0"), std::string::npos);
    EXPECT_NE(faults_with("velocity", R"("scale": [1, 0])").find("'scale' of 0"), std::string::npos);
    for (const char* keys : {R"("reversed": true)", R"("reversed": true, "encoding": "inverse")"})
        EXPECT_NE(faults_with("depth", keys).find("z_buffer or normalized"), std::string::npos) << keys;
}

TEST(CaptureDocument, NeedsFrames) {
    EXPECT_EQ(faults_of_capture(R"({"aftershade": 1})"),
              Lines{"capture.json:1:1: error: the capture has no 'frames'"});
    EXPECT_EQ(faults_of_capture(R"({"aftershade": 1, "frames": 3})"),
              Lines{"capture.json:1:29: error: 'frames' must be a string, not an integer"});
    EXPECT_EQ(faults_of_capture("[]").front(),
              "capture.json:1:1: error: the capture must be an object, not an array");
}

TEST(CaptureDocument, RefusesARangeOfOneFile) {
    EXPECT_EQ(faults_of_capture(R"({"aftershade": 1, "frames": "still.exr", "range": "1-3"})"),
              Lines{"capture.json:1:51: error: 'range' has 3 frames but 'frames' names one file; write the "
                    "frame number "
                    "as ####, %04d or @"});
    const TemporaryFolder folder;
    write_text(folder / "still.exr", "");
    write_text(folder / "capture.json", R"({"aftershade": 1, "frames": "still.exr", "range": "12"})");
    EXPECT_EQ(opened((folder / "capture.json").string()).frames, Frames{12});
}

TEST(FrameGaps, AreTheFramesMissingAtTheStepOfThoseThatAreThere) {
    struct Case {
        Frames frames;
        int step;
        Frames missing;
    };
    const std::vector<Case> cases = {
        {{}, 1, {}},         {{7}, 1, {}},        {{1, 2, 3}, 1, {}},
        {{1, 2, 4}, 1, {3}}, {{1, 3}, 1, {2}},  // two frames alone say nothing of a step
        {{1, 3, 5}, 2, {}},  {{1, 3, 7}, 2, {5}}, {{-4, -2, 2}, 2, {0}},
    };
    for (const auto& [frames, step, missing] : cases) {
        const FrameGaps gaps = find_gaps(frames);
        EXPECT_EQ(gaps.step, step);
        EXPECT_EQ(gaps.missing, missing);
        EXPECT_EQ(gaps.count, std::int64_t(missing.size()));
        EXPECT_EQ(gaps.whole.size(), missing.empty() ? 0 : frames.size() + missing.size());
    }
}

TEST(FrameGaps, ThatAreTooManyAreOnlyCounted) {
    const FrameGaps gaps = find_gaps(Frames{1, 2, 20'240'101});
    EXPECT_EQ(gaps.count, 20'240'098);
    EXPECT_TRUE(gaps.missing.empty());
    EXPECT_TRUE(gaps.whole.empty());
}

}  // namespace
}  // namespace aftershade
