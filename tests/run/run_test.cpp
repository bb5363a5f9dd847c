// Whole runs: when they give back what they hold on the GPU, and how far they read and write ahead.
#include <map>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "framework/run/frame_loader.h"
#include "framework/run/run_frames.h"
#include "tests/backends.h"
#include "tests/render/effect_fixture.h"

namespace aftershade::test {
namespace {

const std::filesystem::path kRoot = AFTERSHADE_SOURCE_DIR;

/// A sequence of three small frames, and a look that has a history.
class Runs : public testing::Test {
protected:
    Runs() {
        effects_.add(
            "blend",
            R"("inputs": { "color": { "role": "color" } }, "outputs": { "color": { "role": "color" } },
            "textures": { "kept": { "format": "rgba32f", "history": true, "doc": "." } },
            "passes": [ { "name": "main", "shader": "main.frag" } ])",
            "void main() {\n    ivec2 p = ivec2(gl_FragCoord.xy);\n"
            "    out_kept = out_color = texelFetch(color, p, 0) + texelFetch(kept_prev, p, 0);\n}\n");
        write_frames(3);
        outputs_.patterns = {(folder_ / "out_#.exr").string()};
        outputs_.compression = "none";
    }

    void write_frames(int count) {
        options_.frames.clear();
        for (int frame = 1; frame <= count; ++frame) {
            const SyntheticScene scene{.width = 16, .height = 9, .background = {float(frame), 0, 0}};
            write_capture(make_capture(scene, frame), folder_ / ("in_" + std::to_string(frame) + ".exr"));
            options_.frames.push_back(frame);
        }
    }
    /// The red of each frame that the run wrote.
    std::map<int, float> reds() {
        std::map<int, float> reds;
        for (const int frame : options_.frames) {
            const auto file = folder_ / ("out_" + std::to_string(frame) + ".exr");
            if (!std::filesystem::is_regular_file(file)) continue;
            reds[frame] = ExrFile(file).read_floats(0, std::vector<std::string>{"R"}).at(3, 2, 0);
            std::filesystem::remove(file);
        }
        return reds;
    }

    /// How often the run ends its context.
    int endings() {
        Diagnostics faults;
        const auto sequence = open_sequence((folder_ / "in_#.exr").string(), faults);
        std::vector<Profile> profiles = read_profiles(kRoot / "profiles", faults);
        EXPECT_FALSE(faults.has_errors());
        const CaptureReader reader(*sequence, std::move(profiles), {});
        const Bound bound(effects_, look_of(R"({ "effect": "blend" })"));
        EXPECT_EQ(bound.faults().find("error"), std::string::npos) << bound.faults();
        std::optional<gpu::Context> context;
        int endings = 0;
        RunSetup setup{
            [&]() -> gpu::Context& { return context ? *context : context.emplace(gpu::test_backend()); },
            bound.pipeline(),
            *sequence,
            reader,
            options_,
            outputs_,
            kRoot};
        setup.end_context = [&] {
            ++endings;
            context.reset();
        };
        setup.hooks = hooks_;
        const std::atomic<bool> stop = false;
        report_ = run_frames(setup, observer_, stop);
        return endings;
    }

    float last_red() const {
        return ExrFile(folder_ / "out_3.exr").read_floats(0, std::vector<std::string>{"R"}).at(3, 2, 0);
    }

    TemporaryFolder folder_;
    EffectFolder effects_;
    RunOptions options_;
    OutputOptions outputs_;
    RunHooks hooks_;
    RunObserver observer_;
    RunReport report_;
};

TEST_F(Runs, EndTheContextOnceAfterTheLastFrameAndStillWriteIt) {
    EXPECT_EQ(endings(), 1);
    EXPECT_EQ(last_red(), 6) << "1 + 2 + 3";
    EXPECT_FALSE(report_.history_saved);
}

TEST_F(Runs, EndItWhereFramesAreMissing) {
    std::filesystem::remove(folder_ / "in_3.exr");
    EXPECT_EQ(endings(), 1);
    EXPECT_EQ(report_.failures.size(), 1U);
}

TEST_F(Runs, KeepItForTheHistoryThatTheySave) {
    options_.history_out = folder_ / "history";
    EXPECT_EQ(endings(), 0);
    EXPECT_TRUE(report_.history_saved);
    EXPECT_EQ(last_red(), 6);
}

TEST_F(Runs, FailWhereTheLastOutputCannotBeWrittenThoughTheContextHasEnded) {
    std::filesystem::create_directories(folder_ / "out_3.exr");
    EXPECT_THROW(endings(), Error);
}

TEST_F(Runs, GiveTheSameHoweverFarTheyReadAndWriteAhead) {
    write_frames(12);
    options_.missing = MissingFrame::hold;
    std::filesystem::remove(folder_ / "in_5.exr");
    endings();
    const auto one_ahead = reds();
    EXPECT_EQ(one_ahead.size(), 12U);
    EXPECT_EQ(one_ahead.at(6), 1 + 2 + 3 + 4 + 4 + 6);
    for (const int ahead : {2, 5, 64}) {
        options_.frames_ahead = ahead;
        endings();
        EXPECT_EQ(reds(), one_ahead) << ahead;
    }
}

TEST_F(Runs, ReportFramesInTheirOrderHoweverManyTheyWriteAtOnce) {
    write_frames(12);
    options_.frames_ahead = 5;
    std::vector<int> written, finished;
    hooks_.frame_written = [&](int frame, const auto&, double) { written.push_back(frame); };
    observer_.frame_finished = [&](const FrameOutcome& outcome) { finished.push_back(outcome.frame); };
    endings();
    EXPECT_EQ(written, options_.frames);
    EXPECT_EQ(finished, options_.frames);
}

TEST_F(Runs, KeepTheFramesBeforeOneThatCannotBeWritten) {
    write_frames(12);
    options_.frames_ahead = 5;
    std::filesystem::create_directories(folder_ / "out_4.exr");
    EXPECT_THROW(endings(), Error);
    const auto kept = reds();
    for (const int frame : {1, 2, 3}) EXPECT_TRUE(kept.contains(frame)) << frame;
    EXPECT_FALSE(kept.contains(12));
}

}  // namespace
}  // namespace aftershade::test
