// Telemetry of a run: numbers of each frame that agree with the textures they are of, and a
// sequence in chunks that is the whole one.
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "framework/file/exr_file.h"
#include "tests/cli/command.h"

namespace aftershade::test::sss_adaptive_telemetry {
namespace {

namespace fs = std::filesystem;

constexpr const char* kLook =
    R"({ "aftershade": 1, "steps": [ { "effect": "sss_adaptive", "params": { "prefilter": true,
    "scattering_profile": { "type": "burley", "d_mm": [3.67, 1.37, 0.68] }, "object_ids": [1] } } ] })";

class SssAdaptiveRun : public testing::Test {
protected:
    void SetUp() override {
        write_text(folder_ / "look.json", kLook);
        run({"render", scenes() + "/light_toggle", "-o", "in", "--size", "96x54", "--frames", "7-12"});
    }
    static std::string scenes() { return AFTERSHADE_SOURCE_DIR "/scenes"; }
    void run(std::vector<std::string> words) {
        const CommandResult result = run_aftershade(words, folder_.path());
        ASSERT_EQ(result.exit_code, 0) << result.err;
    }
    void render(const std::string& frames, const std::string& out, std::vector<std::string> more) {
        std::vector<std::string> words{"run",  "look.json", "in/capture.json", "--frames",   frames,
                                       "-o",   out,         "--output-roles",  "irradiance", "--pixel-type",
                                       "float"};
        words.insert(words.end(), more.begin(), more.end());
        run(words);
    }
    Image tap(const std::string& texture, int frame, const std::vector<std::string>& channels) const {
        return ExrFile(folder_ / ("out.sss_adaptive." + texture + ".000" + std::to_string(frame) + ".exr"))
            .read_floats(0, channels);
    }

    TemporaryFolder folder_;
};

TEST_F(SssAdaptiveRun, TellsOfEachFrameWhatItsTexturesHold) {
    render("7-9", "out_####.exr",
           {"--telemetry", "told_####.json", "--telemetry-plot", "told.svg", "--tap", "sss_adaptive.estimate",
            "--tap", "sss_adaptive.history"});
    for (int frame = 7; frame <= 9; ++frame) {
        const auto told =
            nlohmann::json::parse(read_text(folder_ / ("told_000" + std::to_string(frame) + ".json")));
        EXPECT_EQ(told["frame"], frame);
        const auto& step = told["steps"]["sss_adaptive"];
        const std::vector<std::string> all{"R", "G", "B", "A"};
        const Image estimate = tap("estimate", frame, all), history = tap("history", frame, all);
        double count = 0, samples = 0, variance = 0, most = 0;
        std::vector<int> bins(9);
        for (int y = 0; y < history.height(); ++y)
            for (int x = 0; x < history.width(); ++x) {
                if (history.at(x, y, 3) <= 0) continue;
                const double own = estimate.at(x, y, 3);
                ++count;
                samples += own;
                most = std::max(most, own);
                variance += std::pow(double(history.at(x, y, 1)), 2);
                ++bins[std::size_t(std::min(own / 8, 8.0))];
            }
        ASSERT_GT(count, 100);
        EXPECT_EQ(step["samples"]["count"], count);
        EXPECT_NEAR(step["samples"]["mean"], samples / count, 1e-9);
        EXPECT_EQ(step["samples"]["max"], most);
        EXPECT_EQ(step["samples"]["histogram"]["counts"], bins);
        EXPECT_NEAR(step["variance"]["mean"], variance / count, 1e-9 * variance);
        EXPECT_EQ(step["history_age"]["max"], frame - 6);
        // Each sample fetches one level, or two that it lies between.
        double fetches = 0;
        for (int level = 0; level < 6; ++level)
            fetches += double(step["fetches_mip_" + std::to_string(level)]["sum"]);
        EXPECT_GE(fetches, samples);
        EXPECT_LE(fetches, 2 * samples);
        std::uint64_t bytes = told["memory"]["buffer_bytes"];
        for (const auto& format : told["memory"]["textures"]) bytes += std::uint64_t(format["bytes"]);
        EXPECT_EQ(told["memory"]["bytes"], bytes);
        EXPECT_GT(double(told["passes_ms"]["sss_adaptive.scatter"]), 0);
    }
    const std::string plot = read_text(folder_ / "told.svg");
    EXPECT_NE(plot.find("sss_adaptive.samples"), std::string::npos);
    EXPECT_NE(plot.find("all passes, ms"), std::string::npos);
}

TEST_F(SssAdaptiveRun, HasTheSameBitsInChunks) {
    render("7-12", "whole_####.exr", {});
    render("7-8", "part_####.exr", {"--history-out", "h"});
    render("9-11", "part_####.exr", {"--history-in", "h", "--history-out", "h"});
    render("12", "part_####.exr", {"--history-in", "h"});
    for (int frame = 7; frame <= 12; ++frame) {
        const std::string name = "_00" + std::string(frame < 10 ? "0" : "") + std::to_string(frame) + ".exr";
        const std::vector<std::string> channels{"irradiance.R", "irradiance.G", "irradiance.B"};
        const Image whole = ExrFile(folder_ / ("whole" + name)).read_floats(0, channels),
                    part = ExrFile(folder_ / ("part" + name)).read_floats(0, channels);
        EXPECT_TRUE(std::equal(whole.floats().begin(), whole.floats().end(), part.floats().begin())) << frame;
    }
}

}  // namespace
}  // namespace aftershade::test::sss_adaptive_telemetry
