#include <gtest/gtest.h>

#include <filesystem>
#include <map>
#include <regex>
#include <thread>

#include "framework/golden/approved_image.h"
#include "tests/cli/golden_suite.h"

namespace aftershade::test {
namespace {

namespace fs = std::filesystem;

class GoldenApprove : public GoldenCommand {
protected:
    /// Another renderer's golden in place of this one's.
    void make_foreign(const std::string& name, const std::string& renderer, const std::string& cpu,
                      bool software) {
        GoldenSidecar sidecar;
        sidecar.environment = {"egl", renderer, "4.5 (Core Profile) Mesa 22.3.6", cpu, software};
        sidecar.sources.look = "0";
        sidecar.image_hash = file_hash(image(name));
        write_text(sidecar_path(image(name)), sidecar_text(sidecar));
    }
    void darken(const std::string& name) {
        change_image(image(name), [](Image& pixels) {
            for (float& value : pixels.floats()) value *= 0.5f;
        });
    }
    std::map<std::string, fs::file_time_type> times() const {
        std::map<std::string, fs::file_time_type> all;
        for (const auto& entry : fs::directory_iterator(folder_ / "goldens"))
            all[entry.path().filename().string()] = entry.last_write_time();
        return all;
    }
};

TEST_F(GoldenApprove, WritesWhatIsNewAndTellsItsPaths) {
    const CommandResult first = golden({"approve", "golden.json"});
    EXPECT_EQ(first.exit_code, 0) << first.err;
    EXPECT_EQ(lines_of_text(first.out),
              (std::vector<std::string>{"goldens/corner.color.0001.exr", "goldens/lens.color.0001.exr",
                                        "goldens/lens.color.0002.exr"}));
    const auto before = times();
    const CommandResult again = golden({"approve", "golden.json"});
    EXPECT_EQ(again.exit_code, 0);
    EXPECT_EQ(again.out, "");
    EXPECT_NE(again.err.find("0 images written, 0 sidecars renewed, 3 unchanged"), std::string::npos)
        << again.err;
    EXPECT_EQ(times(), before) << "never writes where nothing changed";
    darken("corner.color.0001");
    EXPECT_EQ(golden({"approve", "golden.json", "--filter", "slow"}).out, "")
        << "the other case is not asked for";
    EXPECT_EQ(golden({"approve", "golden.json"}).out, "goldens/corner.color.0001.exr\n");
    EXPECT_EQ(run().exit_code, 0);
}

TEST_F(GoldenApprove, SaysBesideEachGoldenWhatMadeIt) {
    approve();
    const Json sidecar = Json::parse(read_text(sidecar_path(image("lens.color.0001"))));
    const Json environment = report()["environment"];
    for (const char* key :
         {"backend", "renderer", "version", "mesa", "llvm", "cpu", "instructions", "software"})
        EXPECT_EQ(sidecar[key], environment[key]) << key;
    EXPECT_EQ(sidecar["command"], "aftershade golden approve golden.json");
    EXPECT_EQ(sidecar["image_hash"], file_hash(image("lens.color.0001")));
    for (const char* key : {"look_hash", "capture_hash"})
        EXPECT_EQ(sidecar[key], case_of(report(), "lens")[key]) << key;
}

TEST_F(GoldenApprove, RenewsSidecarsWhereBitsAreEqualOnlyWhenAsked) {
    approve();
    make_foreign("corner.color.0001", "llvmpipe (LLVM 11.0.0, 128 bits)", "Intel Xeon", true);
    const auto before = times();
    approve();
    EXPECT_EQ(times(), before);
    const CommandResult result = golden({"approve", "golden.json", "--renew-sidecars"});
    EXPECT_EQ(result.out, "goldens/corner.color.0001.json\n") << result.err;
    EXPECT_EQ(case_of(report(), "corner")["images"][0]["tier"], "bits");
}

TEST_F(GoldenApprove, KeepsGoldensOfOtherRenderersWhenAsked) {
    approve();
    darken("corner.color.0001");
    make_foreign("corner.color.0001", "llvmpipe (LLVM 11.0.0, 128 bits)", "Intel Xeon", true);
    EXPECT_EQ(run().exit_code, 2);
    const std::string key = report()["environment"]["key"];
    const CommandResult result = golden({"approve", "golden.json", "--add"});
    EXPECT_EQ(result.out, "goldens/corner.color.0001@" + key + ".exr\n") << result.err;
    const Json document = report();
    EXPECT_EQ(document["exit_code"], 0);
    const Json& image_ = case_of(document, "corner")["images"][0];
    EXPECT_EQ(image_["approved"]["key"], key) << "the own renderer's first";
    EXPECT_EQ(image_["approved_count"], 2);
    darken("corner.color.0001@" + key);
    EXPECT_EQ(golden({"approve", "golden.json"}).out, "goldens/corner.color.0001@" + key + ".exr\n")
        << "the own one is replaced, with or without --add";
}

TEST_F(GoldenApprove, LetsACasePassByAnyApprovedImage) {
    approve();
    fs::copy_file(image("corner.color.0001"), image("corner.color.0001@other"));
    darken("corner.color.0001");
    const Json document = report();
    EXPECT_EQ(document["exit_code"], 0);
    EXPECT_EQ(case_of(document, "corner")["images"][0]["approved"]["key"], "other");
}

TEST_F(GoldenApprove, TellsOfGoldensThatOthersApprovedForAnotherLook) {
    approve();
    fs::copy_file(image("lens.color.0001"), image("lens.color.0001@other"));
    make_foreign("lens.color.0001@other", "llvmpipe (LLVM 11.0.0, 128 bits)", "Intel Xeon", true);
    std::string open = kLens;
    open.replace(open.find("0.5"), 3, "1.5");
    write_text(folder_ / "lens.json", open);
    const CommandResult result = golden({"approve", "golden.json"});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_NE(result.err.find("goldens/lens.color.0001@other.exr: warning"), std::string::npos) << result.err;
}

TEST_F(GoldenApprove, RefusesAnotherKindOfRenderer) {
    approve();
    darken("corner.color.0001");
    make_foreign("corner.color.0001", "NVIDIA H200/PCIe/SSE2", "AMD EPYC", false);
    const auto before = contents(folder_ / "goldens");
    const CommandResult result = golden({"approve", "golden.json"});
    EXPECT_EQ(result.exit_code, 64);
    EXPECT_NE(result.err.find("NVIDIA H200/PCIe/SSE2, a hardware renderer"), std::string::npos) << result.err;
    EXPECT_EQ(contents(folder_ / "goldens"), before);
    EXPECT_EQ(golden({"approve", "golden.json", "--filter", "lens"}).exit_code, 0)
        << "whose goldens are of software";
    EXPECT_EQ(golden({"approve", "golden.json", "--any-renderer"}).exit_code, 0);
    EXPECT_EQ(run().exit_code, 0);
}

TEST_F(GoldenApprove, LeavesTheGoldensOfACaseThatDoesNotRender) {
    approve();
    const std::string lens = read_text(image("lens.color.0001"));
    write_text(folder_ / "lens.json", R"({ "aftershade": 1, "steps": [ { "effect": "bokehh" } ] })");
    darken("corner.color.0001");
    const CommandResult result = golden({"approve", "golden.json"});
    EXPECT_EQ(result.exit_code, 2) << result.err;
    EXPECT_EQ(result.out, "goldens/corner.color.0001.exr\n");
    EXPECT_NE(result.err.find("did you mean 'bokeh'"), std::string::npos) << result.err;
    EXPECT_EQ(read_text(image("lens.color.0001")), lens);
}

TEST_F(GoldenApprove, EndsWith4WhereNothingCanBeWritten) {
    write_text(folder_ / "goldens", "a file where the folder should be");
    const CommandResult result = golden({"approve", "golden.json"});
    EXPECT_EQ(result.exit_code, 4) << result.err;
    EXPECT_NE(result.err.find("goldens"), std::string::npos) << result.err;
    EXPECT_EQ(golden({"run", "golden.json"}, {{"TMPDIR", "/nowhere"}}).exit_code, 4);
}

TEST_F(GoldenApprove, LeavesOldOrNewFilesWholeWhereverItIsKilled) {
    approve();
    const auto old_files = contents(folder_ / "goldens");
    write_frame(1, 90);
    write_frame(2, 95);
    int before = 0, after = 0;
    std::map<std::string, std::string> new_files;
    using Milliseconds = std::chrono::milliseconds;
    const auto kill_after = [&](Milliseconds delay) {
        for (const auto& entry : fs::directory_iterator(folder_ / "goldens")) fs::remove(entry.path());
        for (const auto& [name, bytes] : old_files) write_text(folder_ / "goldens" / name, bytes);
        Command command(aftershade_words({"golden", "approve", "golden.json"}), folder_.path());
        std::this_thread::sleep_for(delay);
        command.send(SIGKILL);
        command.wait();
        for (const auto& [name, bytes] : contents(folder_ / "goldens")) {
            if (name.starts_with('.') || !name.ends_with(".exr")) continue;
            const bool is_old = bytes == old_files.at(name);
            (is_old ? before : after) += 1;
            EXPECT_NO_THROW(ExrFile(folder_ / "goldens" / name).read_floats(0, std::vector<std::string>{"R"}))
                << name;
            if (!is_old) {
                EXPECT_EQ(new_files.emplace(name, bytes).first->second, bytes) << name;
            }
        }
    };
    // Ever later until something was renamed, then around that moment.
    Milliseconds delay(40);
    for (; after == 0 && delay < Milliseconds(60'000); delay = delay * 3 / 2) kill_after(delay);
    for (int step = 0; step < 8; ++step) {
        kill_after(delay * (8 + step) / 24);
        const CommandResult judged = run({"--filter", "corner"});
        // 1: killed after the image was renamed and before its sidecar was.
        const bool has_old_sidecar = judged.err.find("is of another image") != std::string::npos;
        EXPECT_TRUE(judged.exit_code == 0 || judged.exit_code == (has_old_sidecar ? 1 : 2))
            << "a file that is not whole is 4; " << judged.exit_code << judged.err;
    }
    EXPECT_GT(before, 0);
    EXPECT_GT(after, 0) << "no run was let live long enough";
    approve();
    EXPECT_EQ(run().exit_code, 0) << "what a killed process left is in nobody's way";
}

TEST_F(GoldenApprove, ReplacesTheSidecarOfAnotherImageThatAKillBetweenTheirRenamesLeaves) {
    approve();
    const std::string old_sidecar = read_text(sidecar_path(image("corner.color.0001")));
    write_frame(1, 90);
    approve();
    const std::string new_sidecar = read_text(sidecar_path(image("corner.color.0001")));
    write_text(sidecar_path(image("corner.color.0001")), old_sidecar);
    EXPECT_EQ(run({"--filter", "corner"}).exit_code, 1);
    EXPECT_EQ(golden({"approve", "golden.json"}).out, "goldens/corner.color.0001.json\n");
    EXPECT_EQ(read_text(sidecar_path(image("corner.color.0001"))), new_sidecar);
    EXPECT_EQ(run({"--filter", "corner"}).exit_code, 0);
}

TEST_F(GoldenApprove, WritesNothingWhenItIsInterrupted) {
    std::string more;  // so many that one at a time is not done before the signal comes
    for (int i = 0; i < 20; ++i)
        more += R"(, { "name": "more_)" + std::to_string(i) + R"(", "steps": [ { "effect": "vignette" } ],
                     "capture": "in_0001.exr" })";
    write_suite(R"("fail": 0.004)", more);
    Command command(aftershade_words({"golden", "approve", "golden.json", "-j", "1"}), folder_.path());
    ASSERT_TRUE(command.wait_until_it_handles(SIGTERM));
    command.send(SIGTERM);
    const CommandResult result = command.wait();
    EXPECT_EQ(result.exit_code, 130) << result.err;
    if (fs::exists(folder_ / "goldens")) {
        EXPECT_EQ(contents(folder_ / "goldens").size(), 0u);
    }
}

TEST_F(GoldenApprove, NamesWhoApprovedAndWhen) {
    const Environment nobody{
        {"GIT_CONFIG_GLOBAL", "/dev/null"}, {"GIT_CONFIG_SYSTEM", "/dev/null"}, {"USER", ""}};
    const auto sidecar = [&](const std::string& name) {
        return Json::parse(read_text(sidecar_path(image(name))));
    };
    ASSERT_EQ(golden({"approve", "golden.json", "--filter", "corner"}, nobody).exit_code, 0);
    EXPECT_FALSE(sidecar("corner.color.0001").contains("approver")) << "nobody is invented";
    EXPECT_TRUE(std::regex_match(sidecar("corner.color.0001")["approved"].get<std::string>(),
                                 std::regex("20[0-9]{2}-[01][0-9]-[0-3][0-9]")));
    const CommandResult result = golden({"approve", "golden.json", "--approver", "Ada \"L\" <b>"}, nobody);
    EXPECT_NE(result.err.find("approved by Ada \"L\" <b>, 20"), std::string::npos) << result.err;
    EXPECT_EQ(sidecar("lens.color.0001")["approver"], "Ada \"L\" <b>");
    EXPECT_FALSE(sidecar("corner.color.0001").contains("approver")) << "which had the same bits";
    const Json approved = case_of(report(), "lens")["images"][0]["approved"]["sidecar"];
    EXPECT_EQ(approved["approver"], "Ada \"L\" <b>");
    EXPECT_EQ(approved["approved"], sidecar("lens.color.0001")["approved"]);
    // Whoever renews sidecars has looked at nothing.
    Json old = sidecar("lens.color.0001");
    old["look_hash"] = "0";
    write_text(sidecar_path(image("lens.color.0001")), old.dump());
    ASSERT_EQ(golden({"approve", "golden.json", "--renew-sidecars", "--approver", "Eve"}, nobody).exit_code,
              0);
    EXPECT_EQ(sidecar("lens.color.0001")["approver"], "Ada \"L\" <b>");
    EXPECT_NE(sidecar("lens.color.0001")["look_hash"], "0");
    darken("corner.color.0001");
    ASSERT_EQ(
        golden({"approve", "golden.json"}, {{"GIT_CONFIG_GLOBAL", "/dev/null"}, {"USER", "grace"}}).exit_code,
        0);
    EXPECT_EQ(sidecar("corner.color.0001")["approver"], "grace");
}

TEST_F(GoldenApprove, KeepsTheGoldensOfACaseThatTheListDoesNotGiveToTheApprover) {
    approve();
    const auto before = contents(folder_ / "goldens");
    darken("corner.color.0001");
    darken("lens.color.0002");
    const auto darkened = contents(folder_ / "goldens");
    write_text(folder_ / "approvers.json", R"({ "aftershade": 1, "approvers": [
        { "cases": ["corner"], "who": ["ada@example.org"] }, { "who": ["grace@example.org"] } ] })");
    const auto as = [&](const std::string& name) {
        write_text(folder_ / "gitconfig",
                   "[user]\n name = " + name + "\n email = " + name + "@example.org\n");
        return golden({"approve", "golden.json"}, {{"GIT_CONFIG_GLOBAL", (folder_ / "gitconfig").string()}});
    };
    const CommandResult eve = as("eve");
    EXPECT_EQ(eve.exit_code, 2) << eve.err;
    EXPECT_NE(eve.err.find("'eve <eve@example.org>' may not approve it; approvers.json names who may"),
              std::string::npos)
        << eve.err;
    EXPECT_EQ(contents(folder_ / "goldens"), darkened);
    EXPECT_EQ(as("ada").out, "goldens/corner.color.0001.exr\n");
    EXPECT_EQ(as("ada").exit_code, 2) << "lens is another's";
    EXPECT_EQ(as("grace").out, "goldens/lens.color.0002.exr\n");
    EXPECT_EQ(as("eve").exit_code, 0) << "nothing is new";
    EXPECT_EQ(read_text(image("corner.color.0001")), before.at("corner.color.0001.exr"));
    const Json sidecar = Json::parse(read_text(sidecar_path(image("lens.color.0002"))));
    EXPECT_EQ(sidecar["approver"], "grace <grace@example.org>");
    EXPECT_EQ(golden({"approve", "golden.json"}, {{"GIT_CONFIG_GLOBAL", "/dev/null"}}).exit_code, 0);
    write_text(folder_ / "approvers.json", "{}");
    EXPECT_EQ(golden({"approve", "golden.json"}).exit_code, 64) << "a list that is faulty gives no one leave";
}

}  // namespace
}  // namespace aftershade::test
