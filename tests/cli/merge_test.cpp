#include <filesystem>
#include <nlohmann/json.hpp>

#include "tests/cli/batch_work.h"

namespace aftershade::test {
namespace {

namespace fs = std::filesystem;

class Merge : public testing::Test {
protected:
    void report(const std::string& name, const std::string& frames, double seconds = 2) {
        fs::create_directories(folder_ / "reports");
        write_text(
            folder_ / ("reports/" + name),
            R"({ "aftershade_report": 1, "look": "/a.json", "capture": "/b", "exit_code": 0, "seconds": )" +
                std::to_string(seconds) + R"(, "frames": [)" + frames + "] }");
    }
    static std::string frame(int number, const std::string& outcome, const std::string& message = "") {
        return R"({ "frame": )" + std::to_string(number) + R"(, "outcome": ")" + outcome +
               R"(", "message": ")" + message + R"(" })";
    }
    CommandResult merge(std::vector<std::string> arguments, int exit_code) {
        arguments.insert(arguments.begin(), "merge");
        arguments.insert(arguments.end(), {"-o", "all.json"});
        CommandResult result = run_aftershade(arguments, folder_.path());
        EXPECT_EQ(result.exit_code, exit_code) << result.err;
        return result;
    }
    nlohmann::json all() { return nlohmann::json::parse(read_text(folder_ / "all.json")); }

    TemporaryFolder folder_;
};

TEST_F(Merge, PutsTheFramesOfAllTasksInOrderAndAddsTheirSecondsUp) {
    report("0001.json", frame(3, "done") + "," + frame(4, "done"));
    report("0002.json", frame(1, "done") + "," + frame(2, "skipped"), 3);
    const CommandResult result = merge({"reports", "--tasks", "2"}, 0);
    EXPECT_EQ(result.err, "3 of 4 frames done, 1 skipped; 2 of 2 tasks reported\n");
    const nlohmann::json merged = all();
    for (int i = 0; i < 4; ++i) EXPECT_EQ(merged["frames"][std::size_t(i)]["frame"], i + 1);
    EXPECT_EQ(merged["seconds"], 5);
    EXPECT_EQ(merged["done"], 3);
    EXPECT_EQ(merged["look"], "/a.json");
    EXPECT_EQ(merged["exit_code"], 0);
}

TEST_F(Merge, SaysWhereATaskFellBackToSoftware) {
    const auto task = [&](const std::string& name, const std::string& gl) {
        report(name, frame(name[3] - '0', "done") + R"( ], "more": [)");
        std::string text = read_text(folder_ / ("reports/" + name));
        text.replace(text.rfind('}'), 1, gl + "}");
        write_text(folder_ / ("reports/" + name), text);
    };
    task("0001.json", R"(, "renderer": "egl: Card", "hardware_not_usable": false)");
    task("0002.json", R"(, "renderer": "osmesa: llvmpipe", "hardware_fault": "egl: none")");
    task("0003.json", R"(, "renderer": "egl: Card", "hardware_not_usable": false)");
    merge({"reports"}, 0);
    EXPECT_EQ(all()["renderer"], "osmesa: llvmpipe");
    EXPECT_EQ(all()["hardware_not_usable"], true);
    EXPECT_EQ(all()["hardware_fault"], "egl: none");
}

TEST_F(Merge, ListsTheFramesThatFailedAndExitsOne) {
    report("0001.json", frame(1, "done") + "," + frame(2, "failed", "in_0002.exr: damaged"));
    report("0002.json", frame(3, "not run"));
    const CommandResult result = merge({"reports"}, 1);
    EXPECT_NE(result.err.find("1 of 3 frames failed:\n  frame 2: in_0002.exr: damaged\n"), std::string::npos)
        << result.err;
    EXPECT_NE(result.err.find("1 of 3 frames done, 1 failed, 1 not run; "), std::string::npos) << result.err;
    EXPECT_EQ(all()["exit_code"], 1);
}

TEST_F(Merge, FailsWhereARunEndedWithAnErrorUnlessALaterReportHasItsFrames) {
    report("0001.json", frame(1, "done"));
    write_text(
        folder_ / "reports/0002.json",
        R"({ "aftershade_report": 1, "exit_code": 6, "seconds": 1, "error": "history: disk \u001b full",
                    "frames": [ { "frame": 2, "outcome": "done" } ] })");
    const CommandResult result = merge({"reports"}, 1);
    EXPECT_NE(result.err.find("0002.json: its run ended with exit code 6: history: disk ? full\n"),
              std::string::npos)
        << result.err;
    EXPECT_EQ(all()["exit_code"], 1);
    EXPECT_NE(all()["error"].get<std::string>().find("exit code 6"), std::string::npos);
    write_text(
        folder_ / "again.json",
        R"({ "aftershade_report": 1, "seconds": 1, "frames": [ { "frame": 2, "outcome": "done" } ] })");
    merge({"reports", "again.json"}, 0);
}

TEST_F(Merge, NamesTheTasksThatHaveNoReportOrABrokenOne) {
    report("0001.json", frame(1, "done"));
    write_text(folder_ / "reports/0002.json", "{ \"aftershade_report\": 1, \"fra");
    const CommandResult result = merge({"reports", "--tasks", "3"}, 1);
    EXPECT_NE(result.err.find("reports/0002.json: is not a report of run --report\n"), std::string::npos)
        << result.err;
    EXPECT_NE(result.err.find("reports/0003.json: no such file"), std::string::npos) << result.err;
    EXPECT_NE(result.err.find("1 of 3 tasks reported"), std::string::npos) << result.err;
    EXPECT_EQ(all()["missing_reports"].size(), 2u);
}

TEST_F(Merge, TakesAFrameAsTheLastReportHasIt) {
    report("first.json", frame(1, "failed", "no memory") + "," + frame(2, "done"));
    report("second.json", frame(1, "done"));
    merge({"reports/first.json", "reports/second.json"}, 0);
    merge({"reports/second.json", "reports/first.json"}, 1);
    // A merged report is a report.
    merge({"all.json", "reports/second.json"}, 0);
}

TEST_F(Merge, CountsNoReportTwiceNorFramesThatAreNone) {
    report("0001.json", frame(1, "done") + "," + frame(2, "done"));
    report("0002.json", frame(2, "done") + "," + frame(3, "done"));
    report("0003.json", R"({ "frame": 1e300, "outcome": "done" })");
    report("0004.json", R"({ "frame": 99999999999, "outcome": "done" })");
    fs::create_symlink("0001.json", folder_ / "reports/0005.json");
    const CommandResult result = merge({"reports"}, 1);
    EXPECT_NE(result.err.find("reports/0002.json: has the frames 2 of reports/0001.json, too"),
              std::string::npos)
        << result.err;
    EXPECT_NE(result.err.find("reports/0003.json: has a frame 1e+300, which is not a whole number"),
              std::string::npos)
        << result.err;
    EXPECT_NE(result.err.find("reports/0004.json: has a frame 99999999999, "), std::string::npos)
        << result.err;
    EXPECT_NE(result.err.find("reports/0005.json: is a symbolic link"), std::string::npos) << result.err;
    EXPECT_NE(result.err.find("2 of 2 frames done; 1 of 5 tasks reported"), std::string::npos) << result.err;
}

}  // namespace
}  // namespace aftershade::test
