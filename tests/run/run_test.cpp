// Whole runs: when they give back what they hold on the GPU, how far they read and write ahead, and how their
// frames overlap.
#include <atomic>
#include <chrono>
#include <fstream>
#include <map>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "framework/run/frame_loader.h"
#include "framework/run/run_frames.h"
#include "tests/backends.h"
#include "tests/render/effect_fixture.h"
#include "tests/scoped_variable.h"

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
        report_ = run_frames(setup, observer_, stop_);
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
    std::atomic<bool> stop_ = false;
};

/// Results that are collected at once, and behind the next frame's passes.
const std::vector<std::string> kWays = {"direct", "mapped"};

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

TEST_F(Runs, BeginAFrameBeforeTheyCollectTheOneBeforeWhereTransfersAreMapped) {
    std::vector<std::string> events;
    const auto note = [&](const std::string& what, int frame) {
        events.push_back(what + " " + std::to_string(frame));
    };
    observer_.frame_started = [&](const Capture& capture) { note("begins", capture.header.frame); };
    hooks_.is_written = [&](int frame) {
        note("is collected", frame);
        return true;
    };
    hooks_.after_frame = [&](int, PipelineRenderer&) {
        std::this_thread::sleep_for(std::chrono::milliseconds(200));  // the next file is read meanwhile
    };
    ScopedVariable way("AFTERSHADE_TRANSFERS");
    way.set("direct");
    endings();
    EXPECT_EQ(events, (std::vector<std::string>{"begins 1", "is collected 1", "begins 2", "is collected 2",
                                                "begins 3", "is collected 3"}));
    events.clear();
    way.set("mapped");
    endings();
    EXPECT_EQ(events, (std::vector<std::string>{"begins 1", "begins 2", "is collected 1", "begins 3",
                                                "is collected 2", "is collected 3"}));
    EXPECT_GT(report_.transfers.buffer_bytes, 0U);
    events.clear();
    options_.on_nan = NanPolicy::fail;  // whether a frame is refused shows before the next one
    endings();
    EXPECT_EQ(events[1], "is collected 1");
}

TEST_F(Runs, GiveTheSameFilesReportsAndHistoryWithEveryWayOfTransfers) {
    write_frames(12);
    options_.frames_ahead = 3;
    options_.missing = MissingFrame::skip;
    options_.history_out = folder_ / "history";
    std::filesystem::remove(folder_ / "in_5.exr");
    std::ofstream(folder_ / "in_9.exr") << "no pixels";
    ScopedVariable way("AFTERSHADE_TRANSFERS");
    std::vector<std::map<int, float>> all;
    std::vector<std::vector<int>> outcomes;
    std::vector<std::string> histories, saved;
    for (const std::string& name : kWays) {
        way.set(name);
        std::vector<int>& ended = outcomes.emplace_back();
        observer_.frame_finished = [&](const FrameOutcome& outcome) {
            if (outcome.kind != FrameOutcome::Kind::skipped) ended.push_back(outcome.frame);
        };
        hooks_.after_frame = [&](int frame, PipelineRenderer& renderer) {
            if (frame == 7) renderer.save_history(folder_ / "seventh");
        };
        endings();
        EXPECT_EQ(report_.failures.size(), 1U);
        EXPECT_EQ(report_.frames_skipped, 1);
        EXPECT_EQ(report_.passes.size(), 3U) << "upload, blend.main, readback";
        for (const PassStatistics& pass : report_.passes) EXPECT_EQ(pass.frames, 10) << pass.pass;
        all.push_back(reds());
        histories.push_back(read_text(folder_ / "history"));
        saved.push_back(read_text(folder_ / "seventh"));
    }
    EXPECT_EQ(all[0].size(), 10U);
    EXPECT_EQ(all[0], all[1]);
    EXPECT_EQ(outcomes[0], outcomes[1]);
    EXPECT_EQ(histories[0], histories[1]);
    EXPECT_EQ(saved[0], saved[1]);
}

TEST_F(Runs, WriteTheSameHalvesAndWarningsWhetherTheGpuRoundsThemOrTheWriterDoes) {
    for (const int frame : options_.frames) {
        const SyntheticScene scene{.width = 200, .height = 100, .background = {30000.7F, 0.1234F, 1e-7F}};
        write_capture(make_capture(scene, frame), folder_ / ("in_" + std::to_string(frame) + ".exr"));
    }
    ScopedVariable way("AFTERSHADE_TRANSFERS");
    for (const NanPolicy policy : {NanPolicy::warn, NanPolicy::fail, NanPolicy::mend}) {
        options_.on_nan = policy;
        std::vector<std::vector<std::string>> files, warnings;
        for (const std::string& name : kWays) {
            way.set(name);
            std::vector<std::string>& said = warnings.emplace_back();
            observer_.non_finite = [&](const std::string& message) { said.push_back(message); };
            endings();
            std::vector<std::string>& written = files.emplace_back();
            for (const int frame : options_.frames)
                written.push_back(read_text(folder_ / ("out_" + std::to_string(frame) + ".exr")));
        }
        EXPECT_TRUE(files[0] == files[1]);
        EXPECT_EQ(warnings[0], warnings[1]);
        ASSERT_EQ(warnings[0].size(), 1U) << "the third frame is above 65504";
        EXPECT_NE(warnings[0][0].find("the largest half, became infinite"), std::string::npos);
    }
}

TEST_F(Runs, WriteEachFrameThatWasBegunWhenTheyAreInterrupted) {
    write_frames(6);
    ScopedVariable way("AFTERSHADE_TRANSFERS");
    for (const std::string& name : kWays) {
        way.set(name);
        stop_ = false;
        observer_.frame_started = [&](const Capture& capture) { stop_ = capture.header.frame == 3; };
        endings();
        EXPECT_TRUE(report_.interrupted);
        EXPECT_EQ(report_.frames_done, 3) << name;
        EXPECT_EQ(reds(), (std::map<int, float>{{1, 1}, {2, 3}, {3, 6}})) << name;
    }
}

TEST_F(Runs, WriteTheFramesBeforeAnErrorWithEveryWayOfTransfers) {
    write_frames(4);
    ScopedVariable way("AFTERSHADE_TRANSFERS");
    for (const std::string& name : kWays) {
        way.set(name);
        hooks_.before_frame = [&](int frame, PipelineRenderer&) {
            if (frame == 4) throw Error(ErrorKind::effect, "the fourth");
        };
        EXPECT_THROW(endings(), Error);
        const auto kept = reds();
        for (const int frame : {1, 2, 3}) EXPECT_TRUE(kept.contains(frame)) << name << " " << frame;
    }
}

}  // namespace
}  // namespace aftershade::test
