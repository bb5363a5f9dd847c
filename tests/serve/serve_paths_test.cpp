// Which files an edit of the page may name: those of the look's and the capture's folders, and no others.
#include <csignal>
#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include "framework/file/png_file.h"
#include "tests/serve/serve_fixture.h"

namespace aftershade::test {
namespace {

namespace fs = std::filesystem;

class ServePaths : public Serve {
protected:
    /// The look lies in "looks", the capture in the folder itself, and "outside" is beside neither.
    void start_in_folders(std::vector<std::string> more = {}) {
        fs::create_directories(outside_.path() / "deep");
        write_files(outside_.path());
        start(more);
        write_files(folder_.path());
        fs::create_symlink(outside_ / "mask.png", folder_ / "link.png");
        fs::create_symlink(outside_.path(), folder_ / "linked");
    }
    static void write_files(const fs::path& folder) {
        Image white(64, 36, 1);
        for (float& value : white.floats()) value = 1;
        write_png(folder / "mask.png", white);
        write_text(folder / "other.json", R"({ "aftershade": 1, "steps": [ { "effect": "sharpen" } ] })");
        write_text(folder / "skin.json", kProfile);
        write_text(folder / "table.cube", "LUT_1D_SIZE 2\n0 0 0\n1 1 1\n");
    }
    Json mask(const fs::path& file) const {
        return {{"op", "mask"}, {"step", 0}, {"value", {{"file", file.string()}}}};
    }
    static Json text(const std::string& steps) {
        return {{"op", "text"}, {"value", "{ \"aftershade\": 1, \"steps\": [ " + steps + " ] }"}};
    }
    /// In each of the four ways that a look has.
    std::vector<Json> edits_that_name(const fs::path& folder) const {
        const auto quoted = [&](const char* file) { return Json((folder / file).string()).dump(); };
        return {mask(folder / "mask.png"),
                text(R"({ "effect": "color_grade", "params": { "lut": )" + quoted("table.cube") + " } }"),
                text(R"({ "use": )" + quoted("other.json") + " }"),
                text(R"({ "effect": "sss_gaussian", "params": { "scattering_profile": )" +
                     quoted("skin.json") + " } }")};
    }
    void expect_refused(const fs::path& folder) const {
        for (const Json& one : edits_that_name(folder)) {
            const Json before = get("/api/state").json();
            const Answer answer = edit(one);
            EXPECT_EQ(answer.status, 403) << one << answer.body;
            EXPECT_NE(answer.body.find("--allow-path"), std::string::npos) << "the remedy: " << answer.body;
            EXPECT_EQ(get("/api/state").json(), before);
        }
    }
    void expect_taken(const fs::path& folder) const {
        for (const Json& one : edits_that_name(folder)) {
            const Answer answer = edit(one);
            EXPECT_EQ(answer.status, 200) << one << answer.body;
            EXPECT_EQ(get("/api/state").json()["faults"], Json::array()) << one;
            post("/api/undo");
        }
    }

    static constexpr const char* kProfile =
        R"({ "aftershade": 1, "summary": "For a test.", "type": "burley", "d_mm": [1, 1, 1], "sources": ["a test"] })";
    TemporaryFolder outside_;
};

TEST_F(ServePaths, OfTheLooksFolderMayBeNamed) {
    start_in_folders();
    expect_taken(".");
    expect_taken(folder_.path());
}

TEST_F(ServePaths, BesideItAreRefusedAbsoluteThroughParentsAndBehindLinks) {
    start_in_folders();
    expect_refused(outside_.path());
    expect_refused(fs::relative(outside_.path(), folder_.path()));
    expect_refused("linked");
    expect_refused(fs::path("linked") / "deep" / "..");
    EXPECT_EQ(edit(mask("link.png")).status, 403);
    EXPECT_EQ(edit(mask("/etc/passwd")).status, 403);
    EXPECT_EQ(edit(mask("../nothing.png")).status, 403) << "whether it is there stays unsaid";
    EXPECT_EQ(edit(text(R"({ "use": "/proc/self/environ" })")).status, 403);
    EXPECT_EQ(
        edit(text(R"({ "effect": "sss_gaussian", "params": { "scattering_profile": "../../../../etc/x" } })"))
            .status,
        403)
        << "a shipped profile's name leads nowhere else either";
    EXPECT_EQ(post("/api/save").status, 200);
    EXPECT_EQ(read_text(folder_ / "look.json"), kLook);
}

TEST_F(ServePaths, TellNothingOfWhatIsElsewhere) {
    start_in_folders();
    const std::string mine = (folder_ / "mask.png").string();
    const auto answer = [&](const std::string& file) { return edit(mask(file)).status; };
    std::set<int> zero;
    for (const std::string name : {"deep", "absent"}) {
        const std::string detour = (outside_ / name).string() + "/";
        for (int up = 1; up < 8; ++up) {
            std::string file = detour;
            for (int i = 0; i < up; ++i) file += "../";
            EXPECT_EQ(answer(file + mine.substr(1)), 403) << file;
        }
        zero.insert(answer((outside_ / name).string() + std::string(1, '\0') + "/../" + mine));
    }
    EXPECT_EQ(zero.size(), 1U);
    fs::create_symlink("/secret/place", outside_ / "hint");
    EXPECT_EQ(edit(mask(outside_ / "hint")).body.find("secret"), std::string::npos);
    const Answer cut = edit(mask("mask.png" + std::string(1, '\0') + "zz"));
    EXPECT_NE((cut.body + get("/api/state").body).find("zero byte"), std::string::npos) << cut.body;
}

TEST_F(ServePaths, OfAllowPathMayBeNamed) {
    start_in_folders({"--allow-path", outside_.path().string()});
    expect_taken(outside_.path());
    expect_taken("linked");
}

TEST_F(ServePaths, ThatTheLookOnDiskNamesStayAndAllowNoOthers) {
    write_files(outside_.path());
    look_ = R"({ "aftershade": 1, "steps": [ { "effect": "vignette", "mask": { "file": )" +
            Json((outside_ / "mask.png").string()).dump() + " } } ] }";
    start();
    EXPECT_EQ(get("/api/state").json()["faults"], Json::array());
    EXPECT_EQ(get("/api/picture?frame=1").status, 200);
    ASSERT_EQ(set(0.5, 0, "strength").status, 200);
    EXPECT_EQ(get("/api/picture?frame=1").status, 200);
    ASSERT_EQ(edit({{"op", "mask"}, {"step", 0}, {"value", nullptr}}).status, 200);
    ASSERT_EQ(edit(mask(outside_ / "mask.png")).status, 200) << "by whoever wrote the look";
    EXPECT_EQ(edit(mask(outside_ / "other.json")).status, 403);
}

TEST_F(ServePaths, OfAShaderThatThePageWritesAreNotReadAsALook) {
    write_effect("mine", "");
    start_in_folders({"--effect-path", "effects"});
    const std::string shader = read_text(folder_ / "effects/mine/main.frag");
    const std::string use = R"({ "use": "effects/mine/main.frag" })";
    const auto rewritten = [&](const std::string& before, const std::string& after) {
        return post("/api/shader",
                    Json{{"effect", "mine"}, {"file", "main.frag"}, {"before", before}, {"text", after}}
                        .dump())
            .status;
    };
    const std::string harmless = text(R"({ "effect": "vignette" })")["value"];
    const std::string mask_outside = R"({ "effect": "vignette", "mask": { "file": )" +
                                     Json((outside_ / "mask.png").string()).dump() + " } }";
    ASSERT_EQ(rewritten(shader, harmless), 200);
    const Answer used = edit(text(use));
    EXPECT_EQ(used.status, 403);
    EXPECT_NE(used.body.find("main.frag' is a shader, which pages can write"), std::string::npos)
        << used.body;
    ASSERT_EQ(rewritten(harmless, text(mask_outside)["value"]), 200);
    EXPECT_EQ(ended_by(SIGINT), 130);

    look_ = text(use)["value"];
    start({"--effect-path", "effects"});
    const Json faults = get("/api/state").json()["faults"];
    ASSERT_EQ(faults.size(), 1u) << "the look on disk has no right to it either";
    EXPECT_NE(faults[0]["message"].get<std::string>().find("is a shader"), std::string::npos) << faults;
    EXPECT_EQ(edit(mask(outside_ / "mask.png")).status, 403) << "it is not named on disk";
    EXPECT_EQ(edit(text(R"({ "effect": "absent" }, )" + mask_outside)).status, 403) << "beside other faults";
}

TEST_F(ServePaths, OfAUsedLookThatChangesLaterAreRefusedByTheProcessThatDrawsToo) {
    start_in_folders();
    ASSERT_EQ(edit(text(R"({ "use": "other.json" })")).status, 200);
    EXPECT_EQ(get("/api/picture?frame=1").status, 200);
    write_text(folder_ / "other.json", text(R"({ "effect": "vignette", "mask": { "file": )" +
                                            Json((outside_ / "mask.png").string()).dump() + " } }")["value"]);
    kill(drawer(), SIGKILL);  // the next one reads the look again
    const Answer picture = get("/api/picture?frame=1");
    EXPECT_EQ(picture.status, 403);
    EXPECT_NE(picture.body.find("mask.png' is not a file that the look named when it was read"),
              std::string::npos)
        << picture.body;
}

/// A profile that an effect's manifest names is read with the first look that has the effect.
TEST_F(ServePaths, OfTheProfileThatAnEffectNamesStayNamedInLaterLooks) {
    start_in_folders();
    ASSERT_EQ(edit(text(R"({ "effect": "sss_burley" })")).status, 200);
    ASSERT_EQ(edit(text(R"({ "effect": "sss_burley", "params": { "samples": 8 } })")).status, 200);
    get("/api/picture?frame=1");
    kill(drawer(), SIGKILL);
    const Answer picture = get("/api/picture?frame=1");
    EXPECT_EQ(picture.status, 200) << picture.body;
}

}  // namespace
}  // namespace aftershade::test
