// $AFTERSHADE_TRANSFERS: the same files either way, and who says which way it is.
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "framework/batch/process_codes.h"
#include "tests/backends.h"
#include "tests/cli/batch_work.h"

namespace aftershade::test {
namespace {

class TransferRuns : public BatchWork {
protected:
    void SetUp() override {
        SKIP_WITHOUT(gpu::test_backend());
        write_text(folder_ / "trail.json", R"({ "aftershade": 1, "steps": [{ "effect": "trail" }] })");
        write_frames(1, 8, 200, 120);
    }
    static Environment way(const std::string& name) { return {{"AFTERSHADE_TRANSFERS", name}}; }
    std::map<std::string, std::string> pictures(const std::string& folder) const {
        std::map<std::string, std::string> pictures;
        for (const auto& [name, bytes] : contents(folder_ / folder))
            if (name.ends_with(".exr")) pictures[name] = bytes;
        return pictures;
    }
};

TEST_F(TransferRuns, WriteTheSameFilesWithWorkersHistoryAndAResumedRun) {
    const auto render = [&](const std::string& folder, const std::string& name,
                            std::vector<std::string> more) {
        std::vector<std::string> arguments{"trail.json", "in_####.exr", "-o", folder + "/out_####.exr"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        return run(arguments, 0, way(name));
    };
    render("direct", "direct", {});
    render("mapped", "mapped", {});
    render("jobs", "mapped", {"--jobs", "2", "--warmup", "8"});
    render("resumed", "mapped", {"--frames", "1-5", "--checkpoint", "2"});
    render("resumed", "mapped", {"--checkpoint", "2"});
    ASSERT_EQ(pictures("direct").size(), 8U);
    for (const char* const folder : {"mapped", "jobs", "resumed"})
        EXPECT_TRUE(pictures(folder) == pictures("direct")) << folder;
}

TEST_F(TransferRuns, SayTheWayAndWhatAFrameWaited) {
    for (const std::string name : {"direct", "mapped"}) {
        const CommandResult result = run(
            {"nothing.json", "in_####.exr", "-o", "out_####.exr", "--verbose", "--overwrite"}, 0, way(name));
        EXPECT_NE(result.err.find("\ntransfers: " + name + ", "), std::string::npos) << result.err;
    }
}

TEST_F(TransferRuns, GoDirectlyWhereALimitLeavesNoRoomForBuffers) {
    const std::vector<std::string> words{"/bin/sh",
                                         "-c",
                                         "ulimit -v 1000000; exec \"$0\" \"$@\"",
                                         AFTERSHADE_EXECUTABLE,
                                         "run",
                                         "nothing.json",
                                         "in_####.exr",
                                         "-o",
                                         "limited/out_####.exr",
                                         "--backend",
                                         "software"};
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
    const CommandResult result = Command(words, folder_.path(), way("mapped")).wait();
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_EQ(pictures("limited").size(), 8U);
#endif
}

TEST_F(TransferRuns, RefuseAnUnknownWay) {
    const CommandResult result =
        run({"trail.json", "in_0001.exr", "-o", "out.exr"}, int(ExitCode::usage), way("pinned"));
    EXPECT_NE(result.err.find("AFTERSHADE_TRANSFERS: 'pinned' is not one of auto, direct, mapped"),
              std::string::npos)
        << result.err;
}

TEST(Doctor, SaysHowTexelsTravel) {
    const TemporaryFolder folder;
    for (const std::string name : {"direct", "mapped"}) {
        const Environment environment{{"AFTERSHADE_TRANSFERS", name}};
        const auto report =
            nlohmann::json::parse(run_aftershade({"doctor", "--json"}, folder.path(), environment).out);
        for (const auto& row : report.at("backends"))
            EXPECT_EQ(row.value("transfers", name), name) << row.at("backend");
        const CommandResult text = run_aftershade({"doctor"}, folder.path(), environment);
        EXPECT_NE(text.out.find("\ntransfers     " + name + " on "), std::string::npos) << text.out;
    }
}

}  // namespace
}  // namespace aftershade::test
