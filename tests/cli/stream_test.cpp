// Frames on standard output: against the files of the same run, and through the real ffmpeg.
#include <cmath>
#include <cstdint>
#include <cstring>

#include "framework/batch/process_codes.h"
#include "framework/file/png_file.h"
#include "tests/cli/batch_work.h"

namespace aftershade::test {
namespace {

namespace fs = std::filesystem;

constexpr int kWidth = 64, kHeight = 36, kStreamFrames = 4;
constexpr std::size_t kValues = std::size_t(kWidth) * kHeight * 3;

class Stream : public BatchWork {
protected:
    Stream() { write_frames(1, kStreamFrames); }
    static std::string number(int frame) { return FramePattern("####").path(frame); }
    /// Of the PNGs, 8 bits a channel, one frame behind the other.
    std::string pixels_of_pngs() const {
        std::string bytes;
        for (int frame = 1; frame <= kStreamFrames; ++frame) {
            const Image picture = read_png(folder_ / ("p_" + number(frame) + ".png"));
            for (int i = 0; i < kWidth * kHeight; ++i)
                for (int c = 0; c < 3; ++c)
                    bytes += char(std::lround(255 * picture.at(i % kWidth, i / kWidth, c)));
        }
        return bytes;
    }
    /// By the shell, so that the stream is a pipe; the exit code is the run's, not the reader's.
    CommandResult piped(const std::vector<std::string>& arguments, const std::string& reader) const {
        std::vector<std::string> all{"/bin/sh", "-c",
                                     "{ \"$0\" \"$@\"; echo $? > code; } | " + reader + "; exit $(cat code)"};
        for (const std::string& word : aftershade_words(words(arguments))) all.push_back(word);
        return Command(all, folder_.path()).wait();
    }
};

TEST_F(Stream, RawFramesAreThePixelsOfThePngs) {
    const CommandResult result =
        run({"trail.json", "in_####.exr", "-o", "-", "--format", "rgb24", "-o", "p_####.png"}, 0);
    ASSERT_EQ(result.out.size(), kStreamFrames * kValues);
    EXPECT_TRUE(result.out == pixels_of_pngs());
    EXPECT_NE(result.err.find("p_0001.png\n"), std::string::npos) << "paths go where messages go";
    EXPECT_NE(result.err.find("ffmpeg -f rawvideo -pixel_format rgb24 -video_size 64x36 -framerate 24 -i -"),
              std::string::npos)
        << result.err;
    EXPECT_FALSE(fs::exists(folder_ / ".aftershade")) << "a stream cannot leave frames out";
}

TEST_F(Stream, SixteenBitsAreTheEncodedColour) {
    const CommandResult result =
        run({"trail.json", "in_####.exr", "-o", "-", "--format", "rgba64le", "-o", "e_####.exr"}, 0);
    const std::size_t values = kValues / 3 * 4;
    ASSERT_EQ(result.out.size(), kStreamFrames * values * 2);
    const char* at = result.out.data();
    for (int frame = 1; frame <= kStreamFrames; ++frame) {
        const Image linear = color("e_" + number(frame) + ".exr");
        for (std::size_t i = 0; i < values; ++i, at += 2) {
            const double x = double(linear.floats()[i]);
            const double encoded = i % 4 == 3       ? x
                                   : x <= 0.0031308 ? 12.92 * x
                                                    : 1.055 * std::pow(x, 1 / 2.4) - 0.055;
            const auto low = std::uint8_t(at[0]), high = std::uint8_t(at[1]);
            ASSERT_NEAR(low + 256 * high, 65535 * std::min(encoded, 1.0), 0.51) << frame << " " << i;
        }
    }
}

TEST_F(Stream, PngFramesAreTheFilesOneBehindTheOther) {
    const CommandResult result =
        run({"nothing.json", "in_####.exr", "-o", "-", "--format", "png", "-o", "p_####.png"}, 0);
    std::string files;
    for (int frame = 1; frame <= kStreamFrames; ++frame)
        files += read_text(folder_ / ("p_" + number(frame) + ".png"));
    EXPECT_TRUE(result.out == files);
}

TEST_F(Stream, AReaderThatEndsIsAnOutputThatCannotBeWritten) {
    write_frames(1, 2, 640, 360);  // more than a pipe holds
    const CommandResult gone =
        piped({"nothing.json", "in_####.exr", "-o", "-", "--format", "rgb24"}, "head -c 100 > /dev/null");
    EXPECT_EQ(gone.exit_code, int(ExitCode::output)) << gone.err;
    EXPECT_NE(gone.err.find("aftershade: error: -o -: the program that reads the frames has ended, after 0 "
                            "whole frames"),
              std::string::npos)
        << gone.err;
    EXPECT_TRUE(temporaries().empty());
}

TEST_F(Stream, AFrameThatFailsEndsItSoThatNoneMovesIntoTheGap) {
    fs::resize_file(frame_path(3), fs::file_size(frame_path(3)) / 2);
    const CommandResult result =
        run({"nothing.json", "in_####.exr", "-o", "-", "--format", "rgb24"}, int(ExitCode::partial));
    EXPECT_EQ(result.out.size(), 2 * kValues);
    EXPECT_NE(result.err.find("-o -: the stream ends before frame 3"), std::string::npos) << result.err;
    fs::remove(frame_path(3));
    EXPECT_EQ(run({"nothing.json", "in_####.exr", "-o", "-", "--format", "rgb24", "--missing", "hold"}, 0)
                  .out.size(),
              kStreamFrames * kValues);
}

TEST_F(Stream, FramesOfTwoSizesAreRefused) {
    write_frames(3, 3, 32, 18);
    const CommandResult result =
        run({"nothing.json", "in_####.exr", "-o", "-", "--format", "rgb24"}, int(ExitCode::output));
    EXPECT_NE(result.err.find("frame 3 has 32 x 18 px, but the frames before it have 64 x 36"),
              std::string::npos)
        << result.err;
}

TEST_F(Stream, WhatDoesNotGoWithItIsRefusedAtOnce) {
    const CommandResult result = run({"nothing.json", "in_####.exr", "-o", "-", "-o", "-", "--jobs", "2",
                                      "--watch", "--resume", "--dry-run", "--progress", "openjd"},
                                     int(ExitCode::usage));
    EXPECT_EQ(result.out, "");
    for (const char* fault :
         {"-o -: error: standard output takes one stream of frames", "-o -: error: add the format",
          "-o -: error: needs all frames in one process",
          "--watch: error: ", "--resume: error: ", "--dry-run: error: ", "--progress openjd: error: "})
        EXPECT_NE(result.err.find(fault), std::string::npos) << fault << "\n" << result.err;
    EXPECT_NE(run({"nothing.json", "in_0001.exr", "-o", "a.png", "--format", "png"}, int(ExitCode::usage))
                  .err.find("--format: error: is for frames on standard output; add -o -"),
              std::string::npos);
}

TEST_F(Stream, TheFfmpegLineKnowsScaleRegionAndRate) {
    write_text(folder_ / "capture.json",
               R"({ "aftershade": 1, "frames": "in_####.exr", "range": "1-4", "fps": 23.976 })");
    EXPECT_EQ(run({"nothing.json", "capture.json", "-o", "-", "--format", "rgb48le", "--print-ffmpeg",
                   "--region", "4,4,40,20", "--scale", "1/2"},
                  0)
                  .out,
              "ffmpeg -f rawvideo -pixel_format rgb48le -video_size 20x10 -framerate 24000/1001 -i -\n");
}

TEST_F(Stream, TheVideoThatFfmpegMakesHasThePixelsOfThePngs) {
    if (!fs::exists("/usr/bin/ffmpeg")) GTEST_SKIP() << "no ffmpeg (Debian package ffmpeg)";
    const std::vector<std::string> arguments{"trail.json", "in_####.exr", "-o", "-",
                                             "--format",   "rgb24",       "-o", "p_####.png"};
    std::vector<std::string> asking = arguments;
    asking.push_back("--print-ffmpeg");
    std::string reader = run(asking, 0).out;
    reader.replace(0, 6, "ffmpeg -loglevel error");
    reader.pop_back();
    piped(arguments, reader + " -c:v ffv1 film.mkv");
    const CommandResult decoded = Command({"/usr/bin/ffmpeg", "-loglevel", "error", "-i", "film.mkv", "-f",
                                           "rawvideo", "-pix_fmt", "rgb24", "-"},
                                          folder_.path())
                                      .wait();
    ASSERT_EQ(decoded.out.size(), kStreamFrames * kValues) << decoded.err;
    EXPECT_TRUE(decoded.out == pixels_of_pngs());
}

/// `-o film.mp4`, with an ffmpeg of the test's own first on PATH.
class Video : public Stream {
protected:
    void write_ffmpeg(const std::string& body) {
        const fs::path program = folder_ / "bin/ffmpeg";
        fs::create_directories(program.parent_path());
        write_text(program, "#!/bin/sh\nfor last; do :; done\nout=${last#file:}\n" + body);
        fs::permissions(program, fs::perms::owner_all);
    }
    CommandResult film(const std::string& output, int code, const std::string& path = "bin:/usr/bin:/bin",
                       const std::vector<std::string>& more = {}) {
        std::vector<std::string> arguments{"run", "nothing.json", "in_####.exr", "-o", output};
        arguments.insert(arguments.end(), more.begin(), more.end());
        const CommandResult result = run_aftershade(arguments, folder_.path(), {{"PATH", path}});
        EXPECT_EQ(result.exit_code, code) << result.err;
        return result;
    }
    std::string decoded(const std::string& file) const {
        return Command({"/usr/bin/ffmpeg", "-loglevel", "error", "-i", file, "-f", "rawvideo", "-pix_fmt",
                        "rgb48le", "-"},
                       folder_.path())
            .wait()
            .out;
    }
};

TEST_F(Video, GoesThroughFfmpegAndAppearsOnceItIsWhole) {
    write_ffmpeg("cat > \"$out\"; echo \"$@\" > words");
    EXPECT_EQ(film("new/my film.mp4", 0).out, "new/my film.mp4\n");
    const std::string raw = run({"nothing.json", "in_####.exr", "-o", "-", "--format", "rgb24"}, 0).out;
    EXPECT_EQ(read_text(folder_ / "new/my film.mp4"), raw);
    EXPECT_NE(read_text(folder_ / "words").find("-video_size 64x36 -framerate 24 -i - "), std::string::npos)
        << read_text(folder_ / "words");
}

TEST_F(Video, IsLeftAsItWasWhereFfmpegOrTheRunFails) {
    write_text(folder_ / "film.mov", "before");
    write_ffmpeg("cat > \"$out\"; exit 3");
    EXPECT_NE(
        film("film.mov", int(ExitCode::output)).err.find("-o film.mov: ffmpeg made no video (exit code 3)"),
        std::string::npos);
    write_ffmpeg("head -c 5000 > \"$out\"");
    EXPECT_NE(film("film.mov", int(ExitCode::output)).err.find("-o film.mov: "), std::string::npos);
    write_ffmpeg("cat > \"$out\"");
    fs::resize_file(frame_path(3), fs::file_size(frame_path(3)) / 2);
    EXPECT_NE(film("film.mov", int(ExitCode::partial)).err.find("-o film.mov: not written"),
              std::string::npos);
    EXPECT_EQ(read_text(folder_ / "film.mov"), "before");
    for (const auto& entry : fs::directory_iterator(folder_.path()))
        EXPECT_NE(entry.path().extension(), ".tmp") << entry.path();
}

TEST_F(Video, SaysWhatItNeedsAndWhatDoesNotGoWithIt) {
    EXPECT_NE(film("film.mp4", int(ExitCode::output), "/nowhere").err.find("needs ffmpeg on PATH"),
              std::string::npos);
    EXPECT_NE(film("film_####.mp4", int(ExitCode::usage)).err.find("a video is one file"), std::string::npos);
    const std::string faults = film("film.mp4", int(ExitCode::usage), "/nowhere",
                                    {"-o", "other.webm", "--jobs", "2", "--resume", "--format", "rgb24"})
                                   .err;
    for (const char* fault : {"a run makes one video", "-o film.mp4: error: needs all frames in one process",
                              "--resume: error: does not go with -o film.mp4", "--format: error: "})
        EXPECT_NE(faults.find(fault), std::string::npos) << fault << "\n" << faults;
}

TEST_F(Video, IsReadByFfmpegInEveryKind) {
    if (!fs::exists("/usr/bin/ffmpeg")) GTEST_SKIP() << "no ffmpeg (Debian package ffmpeg)";
    const std::string raw = run({"nothing.json", "in_####.exr", "-o", "-", "--format", "rgb48le"}, 0).out;
    for (const auto& [name, most] : std::vector<std::pair<std::string, double>>{
             {"film.mkv", 0}, {"film.mov", 0.03}, {"film.mp4", 0.03}, {"film.webm", 0.05}}) {
        film(name, 0);
        const std::string read = decoded(name);
        ASSERT_EQ(read.size(), raw.size()) << name;
        double sum = 0;
        for (std::size_t i = 0; i < raw.size(); i += 2) {
            std::uint16_t a = 0, b = 0;
            std::memcpy(&a, raw.data() + i, 2);
            std::memcpy(&b, read.data() + i, 2);
            sum += std::abs(double(a) - double(b)) / 65535;
        }
        EXPECT_LE(sum / (double(raw.size()) / 2), most) << name;
    }
}

}  // namespace
}  // namespace aftershade::test
