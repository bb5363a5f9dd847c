// Frames that the page has written: images and videos, whole or not at all.
#include <chrono>
#include <csignal>
#include <filesystem>
#include <stop_token>
#include <string>
#include <thread>
#include <vector>

#include "framework/base/atomic_file.h"
#include "framework/base/error.h"
#include "tests/serve/serve_fixture.h"

namespace aftershade::test {
namespace {

namespace fs = std::filesystem;

class ServeExport : public Serve {
protected:
    Answer begin(const std::string& name, const std::string& format) const {
        return post("/api/export/start", Json{{"name", name}, {"format", format}}.dump());
    }
    /// The state at the end of the export.
    Json ended() const {
        for (int i = 0; i < 600; ++i) {
            Json state = get("/api/export").json();
            if (!state["runs"].get<bool>()) return state;
            std::this_thread::sleep_for(std::chrono::milliseconds(100));
        }
        return {};
    }
    /// Names in the look's folder that were not there before.
    std::vector<std::string> made() const {
        std::vector<std::string> names;
        for (const auto& entry : fs::directory_iterator(folder_.path()))
            if (const std::string name = entry.path().filename();
                name != "look.json" && name != "secret.txt" && !name.starts_with("in_"))
                names.push_back(name);
        return names;
    }
};

TEST_F(ServeExport, WritesEachFrameOfTheLookAsEditedAsRunWritesIt) {
    frames_ = 3;
    start();
    ASSERT_EQ(set(1.5).status, 200);
    ASSERT_EQ(begin("shot", "png").status, 200);
    const Json state = ended();
    EXPECT_EQ(state["fault"], "");
    EXPECT_EQ(state["written"], (folder_ / "shot").string());
    EXPECT_EQ(state["done"], 3);
    std::string edited = kLook;
    edited.replace(edited.find("0.5"), 3, "1.5");
    write_text(folder_ / "edited.json", edited);
    Command run(aftershade_words({"run", "edited.json", "in_####.exr", "-o", "own_####.png", "--no-journal",
                                  "--backend", "software"}),
                folder_.path(), {});
    ASSERT_EQ(run.wait().exit_code, 0);
    for (const char* frame : {"0001.png", "0002.png", "0003.png"})
        EXPECT_TRUE(read_text_file(folder_ / "shot" / (std::string("shot_") + frame), ErrorKind::output) ==
                    read_text_file(folder_ / (std::string("own_") + frame), ErrorKind::output))
            << frame;
    EXPECT_EQ(read_text_file(folder_ / "look.json", ErrorKind::output), kLook) << "it was not saved";
    EXPECT_EQ(begin("shot", "exr").status, 409) << "the name is taken";
    ASSERT_EQ(begin("job", "exr").status, 200) << "a file of the export's own has this name";
    EXPECT_EQ(ended()["fault"], "");
    EXPECT_TRUE(fs::is_regular_file(folder_ / "job/job_0003.exr"));
}

TEST_F(ServeExport, LeavesNothingOfWhatIsCancelled) {
    frames_ = 9;
    start();
    ASSERT_EQ(begin("shot", "png").status, 200);
    EXPECT_EQ(begin("other", "png").status, 409) << "one runs";
    ASSERT_EQ(post("/api/export/cancel").status, 200);
    EXPECT_EQ(ended()["fault"], "cancelled; nothing was written");
    EXPECT_EQ(made(), std::vector<std::string>{});
    ASSERT_EQ(begin("shot", "png").status, 200) << "another may follow";
    EXPECT_EQ(ended()["fault"], "");
}

TEST_F(ServeExport, RemovesWhatAKilledProgramLeftOfOne) {
    frames_ = 9;
    start();
    ASSERT_EQ(begin("shot", "png").status, 200);
    command_->send(SIGKILL);
    command_->wait();
    ASSERT_EQ(made().size(), 1u) << "the hidden folder";
    start();
    ASSERT_EQ(begin("shot", "png").status, 200) << "the same again";
    EXPECT_EQ(ended()["fault"], "");
    EXPECT_EQ(made(), std::vector<std::string>{"shot"});
}

TEST_F(ServeExport, LeavesNothingWhereAFrameFailsAndSaysWhy) {
    frames_ = 3;
    start();
    write_text(folder_ / "in_0002.exr", "no picture");
    ASSERT_EQ(begin("shot", "exr").status, 200);
    const std::string fault = ended()["fault"];
    EXPECT_NE(fault.find("in_0002.exr"), std::string::npos);
    EXPECT_EQ(fault.find(".aftershade-"), std::string::npos) << fault;
    EXPECT_EQ(made(), std::vector<std::string>{});
}

/// Frames 1, 2 and 4.
class ServeExportWithGaps : public ServeExport {
protected:
    void change_frames() const override { fs::remove(folder_ / "in_0003.exr"); }
    ServeExportWithGaps() { frames_ = 4; }
};

TEST_F(ServeExportWithGaps, LeavesOutNumbersWithoutAFrameAsThePageDoes) {
    start();
    ASSERT_EQ(begin("shot", "png").status, 200);
    const Json state = ended();
    EXPECT_EQ(state["fault"], "");
    EXPECT_EQ(state["done"], 3);
    EXPECT_EQ(state["frames"], 3);
    EXPECT_TRUE(fs::exists(folder_ / "shot/shot_0004.png"));
    EXPECT_FALSE(fs::exists(folder_ / "shot/shot_0003.png"));
    EXPECT_TRUE(get("/api/command").json()["command"].get<std::string>().ends_with(" --missing skip"));
}

TEST_F(ServeExport, GivesEveryStillBesideThePicturesOfAViewer) {
    start();
    const std::string still = get("/api/picture?frame=1&format=png").body;
    std::vector<std::jthread> viewers;
    for (int i = 0; i < 2; ++i)
        viewers.emplace_back([&](const std::stop_token& stop) {
            while (!stop.stop_requested()) get("/api/picture?frame=1");
        });
    for (int i = 0; i < 30; ++i) {
        const Answer answer = get("/api/picture?frame=1&format=png");
        EXPECT_EQ(answer.status, 200) << answer.body;
        EXPECT_TRUE(answer.body == still) << i;
    }
}

TEST_F(ServeExport, GivesTheStillAsTheFileThatItWrites) {
    start();
    ASSERT_EQ(begin("shot", "png").status, 200);
    ASSERT_EQ(ended()["fault"], "");
    const std::string file = read_text_file(folder_ / "shot/shot_0001.png", ErrorKind::output);
    EXPECT_TRUE(get("/api/picture?frame=1&format=png").body == file);
    EXPECT_EQ(get("/api/picture?frame=1&format=png&view=before").status, 400);
    EXPECT_EQ(get("/api/picture?frame=1&format=gif").status, 400);
    ASSERT_EQ(set(1e9).status, 200);
    EXPECT_EQ(get("/api/picture?frame=1&format=png").status, 409)
        << "the last good picture is not the look's";
}

TEST_F(ServeExport, RefusesNamesThatLeaveTheFolderOtherFormatsAndLooksWithFaults) {
    start();
    for (const char* name : {"", "../out", "/tmp/out", ".out", "a/b", "a#b"})
        EXPECT_EQ(begin(name, "png").status, 400) << name;
    EXPECT_EQ(begin("shot", "gif").status, 400);
    EXPECT_EQ(post("/api/export/start", "{}").status, 400);
    ASSERT_EQ(set(1e9).status, 200);
    const Answer refused = begin("shot", "png");
    EXPECT_EQ(refused.status, 409);
    EXPECT_NE(refused.body.find("the look has faults"), std::string::npos) << refused.body;
    EXPECT_EQ(made(), std::vector<std::string>{});
}

TEST_F(ServeExport, WritesNothingWithReadOnly) {
    start({"--read-only"});
    EXPECT_EQ(begin("shot", "png").status, 403);
    EXPECT_EQ(made(), std::vector<std::string>{});
}

TEST_F(ServeExport, NamesTheRemedyForAVideoWithoutFfmpeg) {
    environment_["PATH"] = "/nowhere";
    start();
    const Answer refused = begin("film", "mp4");
    EXPECT_EQ(refused.status, 409);
    EXPECT_NE(refused.body.find("Debian package ffmpeg"), std::string::npos) << refused.body;
}

}  // namespace
}  // namespace aftershade::test
