// What a run tells while it works: lines for people, JSON for programs, a trace for viewers.
#include <algorithm>
#include <nlohmann/json.hpp>
#include <regex>
#include <set>

#include "framework/batch/process_codes.h"
#include "tests/cli/batch_work.h"

namespace aftershade::test {
namespace {

using nlohmann::json;

class Progress : public BatchWork {
protected:
    Progress() { write_frames(1, 4); }
    CommandResult sequence(std::vector<std::string> more, int exit_code = 0) const {
        more.insert(more.begin(), {"trail.json", "in_####.exr", "-o", "out_####.exr"});
        return run(more, exit_code);
    }
};

TEST_F(Progress, PlainLinesGiveRateAndTimeLeftAndATableOfStages) {
    const CommandResult result = sequence({"--progress", "plain", "--verbose"});
    EXPECT_TRUE(std::regex_search(result.err, std::regex("frame 1 \\(1/4\\)\n"))) << result.err;
    EXPECT_TRUE(
        std::regex_search(result.err, std::regex("frame 3 \\(3/4\\), [0-9.e+]+ frames/s, [0-9.]+ s left\n")))
        << result.err;
    for (const char* stage : {"decode", "upload", "passes", "readback", "encode"})
        EXPECT_TRUE(
            std::regex_search(result.err, std::regex("\n" + std::string(stage) + " +[0-9.]+ +[0-9.]+\n")))
            << stage << "\n"
            << result.err;
}

TEST_F(Progress, SaysByDefaultOnlyWhatAPersonNeeds) {
    const CommandResult result = sequence({"--progress", "plain", "--frames", "1"});
    const std::vector<std::string> lines = lines_of_text(result.err);
    EXPECT_LE(lines.size(), 12u) << result.err;
    EXPECT_TRUE(std::regex_match(lines.back(), std::regex("1 of 1 frames in [0-9.]+ s, .*: llvmpipe .*")))
        << result.err;
}

TEST_F(Progress, JsonIsAnObjectALineAndEndsWithTheStages) {
    std::filesystem::remove(frame_path(3));
    const CommandResult result = sequence({"--progress", "json", "--frames", "1-4"}, int(ExitCode::partial));
    std::vector<int> frames;
    json last;
    std::set<std::string> events;
    for (const std::string& line : lines_of_text(result.err)) {
        ASSERT_TRUE(line.starts_with('{')) << line;
        last = json::parse(line);
        events.insert(last.at("event"));
        if (last.at("event") == "frame") frames.push_back(last.at("frame"));
    }
    EXPECT_EQ(frames, (std::vector<int>{1, 2, 4}));
    EXPECT_TRUE(events.contains("failed") && events.contains("history")) << result.err;
    EXPECT_EQ(last.at("event"), "end");
    EXPECT_EQ(last.at("frames_done"), 3);
    EXPECT_EQ(last.at("failed"), json::array({3}));
    EXPECT_GT(last.at("stages").at("decode").at("busy_s").get<double>(), 0);
    EXPECT_GT(last.at("wall_s").get<double>(), last.at("stages").at("passes").at("busy_s").get<double>());
}

TEST_F(Progress, FailedFramesAreListedAtTheEnd) {
    for (const int frame : {2, 3}) std::filesystem::remove(frame_path(frame));
    const CommandResult result = sequence({"--progress", "plain"}, int(ExitCode::partial));
    EXPECT_NE(result.err.find("2 of 4 frames failed: 2-3\n"), std::string::npos) << result.err;
}

TEST_F(Progress, ATraceHasEachFrameItsFilesAndItsPassesWithoutOverlapInARow) {
    sequence({"--trace", "traces/run.json"});
    const json trace = json::parse(read_text(folder_ / "traces/run.json"));
    std::map<std::string, int> counts;
    std::map<int, std::vector<std::pair<double, double>>> rows;
    for (const json& event : trace.at("traceEvents")) {
        if (event.at("ph") != "X") continue;
        ++counts[event.at("cat")];
        const double start = event.at("ts");
        rows[event.at("tid")].push_back({start, start + event.at("dur").get<double>()});
    }
    EXPECT_EQ(counts["frames"], 4);
    EXPECT_EQ(counts["decode"], 4);
    EXPECT_EQ(counts["encode"], 4);
    EXPECT_EQ(counts["scan"], 2 * 4) << "captures and outputs are searched for NaN";
    EXPECT_EQ(counts["passes"], 4 * 4) << "upload, two passes, readback";
    for (auto& [row, times] : rows) {
        std::ranges::sort(times);
        for (std::size_t i = 1; i < times.size(); ++i)
            EXPECT_LE(times[i - 1].second, times[i].first + 1)
                << "row " << row;  // us; times have one decimal
    }
}

TEST_F(Progress, TheFirstFileIsReadWhileTheContextAndTheGraphAreMade) {
    // Of a shipped effect: others run in a process whose memory is limited, where the context comes first.
    write_text(folder_ / "sharp.json", R"({ "aftershade": 1, "steps": [{ "effect": "sharpen" }] })");
    run({"sharp.json", "in_####.exr", "-o", "out_####.exr", "--trace", "run.json"}, 0);
    const json trace = json::parse(read_text(folder_ / "run.json"));
    std::map<std::string, double> first_us;
    for (const json& event : trace.at("traceEvents"))
        if (event.at("ph") == "X")
            first_us.try_emplace(event.at("cat").get<std::string>(), event.at("ts").get<double>());
    EXPECT_LT(first_us.at("decode"), first_us.at("frames"));
}

}  // namespace
}  // namespace aftershade::test
