// A page that starts from a capture alone, or with the name of a look that is not there yet.
#include <csignal>
#include <filesystem>
#include <string>
#include <vector>

#include "framework/base/atomic_file.h"
#include "tests/serve/serve_fixture.h"

namespace aftershade::test {
namespace {

namespace fs = std::filesystem;

class ServeStart : public Serve {
protected:
    Answer save_as(const std::string& name) const { return post("/api/save", Json{{"name", name}}.dump()); }
    std::vector<std::string> files() const {
        std::vector<std::string> names;
        for (const auto& entry : fs::directory_iterator(folder_.path()))
            names.push_back(entry.path().filename().string());
        std::ranges::sort(names);
        return names;
    }
};

TEST_F(ServeStart, WithoutALookBeginsEmptyAndIsSavedUnderANewNameOfItsFolderAlone) {
    look_name_ = "";
    start();
    EXPECT_TRUE(get("/api/state").json()["steps"].empty());
    EXPECT_FALSE(get("/api/state").json()["look"]["has_name"]);
    EXPECT_EQ(get("/api/picture?frame=1").status, 200) << "the capture's colour";
    EXPECT_EQ(get("/api/command").status, 409) << "there is no file to run";
    const std::vector<std::string> before = files();
    fs::create_symlink("nowhere.json", folder_ / "link.json");
    for (const char* name : {"", "../up", "a/b", "/tmp/x", ".hidden", "line\nbreak"})
        EXPECT_EQ(save_as(name).status, 400) << name;
    EXPECT_EQ(save_as("link").status, 409) << "a link is followed nowhere";
    fs::remove(folder_ / "link.json");
    EXPECT_EQ(files(), before);
    ASSERT_EQ(edit({{"op", "add"}, {"at", 0}, {"effect", "vignette"}}).status, 200);
    EXPECT_EQ(save_as("mine").status, 200);
    EXPECT_EQ(read_text(folder_ / "mine.json"), get("/api/state").json()["text"].get<std::string>());
    EXPECT_EQ(save_as("other").status, 409) << "it keeps its name";
    EXPECT_EQ(post("/api/save").status, 200);
    EXPECT_NE(get("/api/command").body.find("mine.json"), std::string::npos);
    EXPECT_EQ(ended_by(SIGINT), 130);
}

TEST_F(ServeStart, NeverSavesOverAFileThatIsThere) {
    look_name_ = "";
    start();
    write_text(folder_ / "taken.json", "{}");
    EXPECT_EQ(save_as("taken").status, 409);
    EXPECT_EQ(read_text(folder_ / "taken.json"), "{}");
}

TEST_F(ServeStart, MakesTheFileThatItsCommandNamesWithTheFirstSave) {
    look_name_ = "new.json";
    start();
    EXPECT_FALSE(fs::exists(folder_ / "new.json"));
    ASSERT_EQ(edit({{"op", "add"}, {"at", 0}, {"effect", "vignette"}}).status, 200);
    ASSERT_EQ(post("/api/save").status, 200);
    EXPECT_EQ(read_text(folder_ / "new.json"),
              "{\n  \"aftershade\": 1,\n  \"steps\": [\n    { \"effect\": \"vignette\" }\n  ]\n}\n");
}

TEST_F(ServeStart, WritesNothingWithReadOnly) {
    look_name_ = "";
    start({"--read-only"});
    const std::vector<std::string> before = files();
    EXPECT_EQ(save_as("mine").status, 403);
    EXPECT_EQ(post("/api/thumbnail?frame=1", R"({"edits": []})").status, 200);
    EXPECT_EQ(files(), before);
}

TEST_F(ServeStart, DrawsThumbnailsInAnotherProcessAndChangesNothingByThem) {
    start();
    const Json before = get("/api/state").json();
    const auto thumbnail = [&](const Json& edit) {
        return post("/api/thumbnail?frame=1", Json{{"edits", {edit}}}.dump());
    };
    const Answer drawn = thumbnail({{"op", "set"}, {"step", 1}, {"param", "exposure"}, {"value", 3}});
    EXPECT_EQ(drawn.status, 200) << drawn.body;
    EXPECT_TRUE(drawn.body.starts_with("\x89PNG"));
    EXPECT_EQ(get("/api/state").json(), before);
    ASSERT_EQ(set(3).status, 200);
    EXPECT_EQ(get("/api/picture?frame=1").body, drawn.body) << "64 px are no more than a thumbnail has";
    EXPECT_EQ(thumbnail({{"op", "add"}, {"at", 0}, {"effect", "vignete"}}).status, 409);
    EXPECT_EQ(thumbnail({{"op", "mask"}, {"step", 0}, {"value", {{"file", "/etc/passwd"}}}}).status, 403);
    EXPECT_EQ(post("/api/thumbnail?frame=9", R"({"edits": []})").status, 404);
}

TEST_F(ServeStart, ListsLooksThatFitAndFocusesThemOnWhatTheFrameShows) {
    start();
    const Json looks = get("/api/starts?frame=1").json();
    ASSERT_GT(looks.size(), 4u);
    bool has_portrait = false;
    for (const Json& look : looks) {
        EXPECT_NE(look.contains("text"), look.contains("needs")) << look;
        has_portrait = has_portrait || (look["name"] == "portrait" && look.contains("text"));
        if (look.contains("text")) {
            EXPECT_EQ(post("/api/thumbnail?frame=1",
                           Json{{"edits", {{{"op", "text"}, {"value", look["text"]}}}}}.dump())
                          .status,
                      200)
                << look;
        }
    }
    EXPECT_TRUE(has_portrait);
}

}  // namespace
}  // namespace aftershade::test
