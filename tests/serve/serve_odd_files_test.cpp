// What happens when a file that serve reads becomes something that cannot be read to an end.
#include <sys/stat.h>

#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <string>

#include "tests/serve/serve_fixture.h"

namespace aftershade::test {
namespace {

namespace fs = std::filesystem;

class ServeOddFiles : public Serve, public ::testing::WithParamInterface<const char*> {
protected:
    void SetUp() override {
        write_effect("mine", "c *= 2.0;");
        write_text(folder_ / "skin.json", R"({ "aftershade": 1, "summary": "For a test.", "type": "burley",
  "d_mm": [1, 1, 1], "sources": ["a test"] })");
        write_text(folder_ / "other.json", R"({ "aftershade": 1, "steps": [ { "effect": "sharpen" } ] })");
        look_ = R"({ "aftershade": 1, "steps": [ { "use": "other.json" }, { "effect": "mine" },
  { "effect": "sss_gaussian", "params": { "scattering_profile": "skin.json" } } ] })";
    }
    void replace(const std::string& file, const std::string& kind) const {
        fs::remove(folder_ / file);
        if (kind == "pipe") mkfifo((folder_ / file).c_str(), 0600);
        else if (kind == "endless file") fs::create_symlink("/dev/zero", folder_ / file);
        else {
            std::ofstream(folder_ / file).put(' ');
            fs::resize_file(folder_ / file, std::uintmax_t(2) << 30);
        }
    }
};

TEST_P(ServeOddFiles, HoldUpNoRequestAndNoEnd) {
    const std::string file = GetParam();
    for (const std::string kind : {"pipe", "endless file", "sparse file"}) {
        start({"--effect-path", "effects"});
        ASSERT_EQ(get("/api/picture?frame=1").status, 200) << get("/api/picture?frame=1").body;
        const std::string kept = read_text(folder_ / file);
        replace(file, kind);
        const auto answered = [&](const Answer& answer, const char* what) {
            EXPECT_GE(answer.status, 200) << what << " with a " << kind << " as " << file;
            return answer;
        };
        const auto begin = std::chrono::steady_clock::now();
        answered(get("/api/changes"), "changes");
        answered(get("/api/state"), "state");
        answered(get("/api/shaders?effect=mine"), "shaders");
        answered(edit({{"op", "set"}, {"step", 2}, {"param", "mix"}, {"value", 0.5}}), "edit");
        const Answer saved = answered(post("/api/save"), "save");
        if (file == "look.json") {
            EXPECT_EQ(saved.status, 500);
            EXPECT_NE(saved.body.find(kind == "sparse file" ? "the limit is" : "is not a regular file"),
                      std::string::npos)
                << saved.body;
        }
        kill(drawer(), SIGKILL);  // the next one reads everything again
        answered(get("/api/picture?frame=1"), "picture");
        EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(10)) << "six requests";
        const auto end = std::chrono::steady_clock::now();
        EXPECT_EQ(ended_by(SIGINT), 130);
        EXPECT_LT(std::chrono::steady_clock::now() - end, std::chrono::seconds(2));
        fs::remove(folder_ / file);
        write_text(folder_ / file, kept);
    }
}

TEST_F(Serve, WarnsOfALookOnDiskThatIsTooLongUntilItIsShortAgain) {
    start();
    const std::string kept = read_text(folder_ / "look.json");
    write_text(folder_ / "look.json", kept + std::string(2 << 20, ' '));
    get("/api/changes");
    const Json state = get("/api/state").json();
    EXPECT_EQ(state["text"], kept);
    ASSERT_EQ(state["faults"].size(), 1u) << state["faults"];
    EXPECT_EQ(state["faults"][0]["severity"], "warning");
    EXPECT_NE(state["faults"][0]["message"].get<std::string>().find("bytes, the limit is 1048576"),
              std::string::npos)
        << state["faults"];
    EXPECT_EQ(get("/api/picture?frame=1").status, 200);
    EXPECT_EQ(post("/api/save").status, 409) << "it would replace what is there";
    write_text(folder_ / "look.json", kept);
    get("/api/changes");
    EXPECT_EQ(get("/api/state").json()["faults"], Json::array());
}

INSTANTIATE_TEST_SUITE_P(Each, ServeOddFiles,
                         ::testing::Values("look.json", "other.json", "skin.json", "effects/mine/effect.json",
                                           "effects/mine/main.frag", "in_0001.exr"));

}  // namespace
}  // namespace aftershade::test
