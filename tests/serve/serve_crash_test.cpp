// What happens to the page when the process that draws for it ends.
#include <algorithm>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "tests/serve/serve_fixture.h"

namespace aftershade::test {
namespace {

using namespace std::chrono_literals;

class ServeCrash : public Serve {
protected:
    Json state() const { return get("/api/state").json(); }
    /// Mesa's compiler recurses over a quarter of a million terms, and its stack ends.
    void write_effect_that_crashes(const std::string& id) {
        write_effect(id, "c = F(F(F(F(F(F(F(F(F(c)))))))));", "#define F(x) x*x+x*x\n");
    }
    std::vector<std::string> faults() const {
        std::vector<std::string> messages;
        const Json now = state();
        for (const Json& fault : now["faults"]) messages.push_back(fault["message"]);
        return messages;
    }
};

TEST_F(ServeCrash, CostsNeitherTheSessionNorThePicture) {
    start();
    const std::string first = get("/api/picture?frame=1").body;
    ASSERT_EQ(set(2).status, 200);
    const std::string brighter = get("/api/picture?frame=1").body;
    ASSERT_NE(brighter, first);
    for (const int signal : {SIGSEGV, SIGABRT, SIGKILL}) {
        const pid_t before = drawer();
        ASSERT_GT(before, 0);
        kill(before, signal);
        const Answer again = get("/api/picture?frame=1");
        EXPECT_EQ(again.status, 200) << again.body;
        EXPECT_EQ(again.body, brighter) << "the unsaved change";
        EXPECT_NE(drawer(), before);
        EXPECT_TRUE(faults().empty());
    }
    EXPECT_EQ(read_text(folder_ / "look.json"), kLook);
    ASSERT_EQ(post("/api/undo").status, 200);
    EXPECT_EQ(get("/api/picture?frame=1").body, first);
    EXPECT_EQ(ended_by(SIGINT), 130);
}

TEST_F(ServeCrash, OfTheSameStepAgainIsAFaultThatNamesThePassWithTheLastGoodPicture) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
    GTEST_SKIP() << "the sanitizer reports the driver's crash in its own words";
#endif
    write_effect_that_crashes("deep");
    start({"--effect-path", "effects"});
    const std::string first = get("/api/picture?frame=1").body;
    ASSERT_EQ(edit({{"op", "add"}, {"at", 0}, {"effect", "deep"}}).status, 200);
    const std::string text = state()["text"];
    const std::string words =
        "the GL driver crashed (signal 11, SIGSEGV) while compiling pass 'main' of step 'deep'";
    const Answer refused = get("/api/picture?frame=1");
    EXPECT_EQ(refused.status, 409);
    EXPECT_NE(refused.body.find(words), std::string::npos) << refused.body;
    ASSERT_EQ(faults().size(), 1u);
    EXPECT_TRUE(faults()[0].starts_with(words)) << faults()[0];
    EXPECT_EQ(state()["text"], text) << "what was typed is kept";
    EXPECT_EQ(get("/api/picture?frame=1").body, first);
    const pid_t after = drawer();
    EXPECT_EQ(get("/api/picture?frame=1&scale=4").status, 200);
    EXPECT_EQ(drawer(), after) << "what crashes is not tried again";
    ASSERT_EQ(post("/api/undo").status, 200);
    EXPECT_TRUE(faults().empty());
    EXPECT_EQ(get("/api/picture?frame=1").body, first);
    ASSERT_EQ(post("/api/redo").status, 200);
    EXPECT_EQ(faults().size(), 1u);
    EXPECT_EQ(get("/api/picture?frame=1").body, first);
    EXPECT_EQ(ended_by(SIGINT), 130);
}

TEST_F(ServeCrash, OfAShaderThatWasDrawnBeforeIsAFaultUntilTheShaderIsMended) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
    GTEST_SKIP() << "the sanitizer reports the driver's crash in its own words";
#endif
    write_effect("mine", "c *= 2.0;");
    start({"--effect-path", "effects"});
    ASSERT_EQ(edit({{"op", "add"}, {"at", 0}, {"effect", "mine"}}).status, 200);
    const std::string first = get("/api/picture?frame=1").body;
    write_effect_that_crashes("mine");
    get("/api/changes");
    EXPECT_EQ(get("/api/picture?frame=1").status, 409);
    ASSERT_EQ(faults().size(), 1u);
    const Answer kept = get("/api/picture?frame=1");
    EXPECT_EQ(kept.status, 200) << kept.body;
    EXPECT_EQ(kept.body, first) << "the last good picture";
    EXPECT_EQ(get("/api/picture?frame=1&view=before").status, 409) << "of which none was drawn";
    EXPECT_EQ(state()["has_picture"], true);
    write_effect("mine", "c *= 2.0;");
    get("/api/changes");
    EXPECT_TRUE(faults().empty());
    EXPECT_EQ(get("/api/picture?frame=1").body, first);
}

TEST_F(ServeCrash, OfAPassThatDoesNotEndIsOneOfTheSameKind) {
    std::string lines;
    for (int i = 0; i < 6'000; ++i) lines += "c = c * 1.01 + sin(c * " + std::to_string(i) + ".0);\n";
    write_effect("long", lines);
    start({"--effect-path", "effects", "--pass-timeout", "1"});
    const std::string first = get("/api/picture?frame=1").body;
    ASSERT_EQ(edit({{"op", "add"}, {"at", 0}, {"effect", "long"}}).status, 200);
    EXPECT_EQ(get("/api/picture?frame=1").status, 409);
    ASSERT_EQ(faults().size(), 1u);
    EXPECT_TRUE(faults()[0].starts_with("the GL driver did not finish within 1 s and was killed while "))
        << faults()[0];
    EXPECT_EQ(get("/api/picture?frame=1").body, first);
}

TEST_F(ServeCrash, NoEditAndNoFileOfThePageWaitsForAPassThatDoesNotEnd) {
    std::string lines;
    for (int i = 0; i < 6'000; ++i) lines += "c = c * 1.01 + sin(c * " + std::to_string(i) + ".0);\n";
    write_effect("long", lines);
    start({"--effect-path", "effects", "--pass-timeout", "5"});
    ASSERT_EQ(edit({{"op", "add"}, {"at", 0}, {"effect", "long"}}).status, 200);
    const auto begin = std::chrono::steady_clock::now();
    std::vector<std::unique_ptr<Client>> waiting;
    for (int i = 0; i < 12; ++i) {
        waiting.push_back(std::make_unique<Client>(port_));
        waiting.back()->send(head("GET /api/probe?frame=1&y=1&x=" + std::to_string(i)) + "\r\n");
    }
    EXPECT_EQ(set(2, 2).status, 200);
    EXPECT_EQ(get("/").status, 200);
    EXPECT_LT(std::chrono::steady_clock::now() - begin, 3s) << "the time of the pass is 5 s";
    for (const auto& client : waiting) EXPECT_EQ(parsed(client->receive()).status, 409);
    EXPECT_GT(std::chrono::steady_clock::now() - begin, 4s) << "or nothing hung";
}

TEST_F(ServeCrash, NoPictureWaitsForAThumbnailThatDoesNotEnd) {
    std::string lines;
    for (int i = 0; i < 6'000; ++i) lines += "c = c * 1.01 + sin(c * " + std::to_string(i) + ".0);\n";
    write_effect("long", lines);
    start({"--effect-path", "effects", "--pass-timeout", "5"});
    EXPECT_EQ(get("/api/picture?frame=1").status, 200);
    const auto begin = std::chrono::steady_clock::now();
    const Client waiting(port_);
    const std::string body = R"({"edits": [{"op": "add", "at": 0, "effect": "long"}]})";
    waiting.send(
        head("POST /api/thumbnail?frame=1", "Content-Length: " + std::to_string(body.size()) + "\r\n") +
        "\r\n" + body);
    for (const double exposure : {1, 2, 3}) {
        EXPECT_EQ(set(exposure).status, 200);
        EXPECT_EQ(get("/api/picture?frame=1").status, 200);
    }
    EXPECT_LT(std::chrono::steady_clock::now() - begin, 3s) << "the time of the pass is 5 s";
    EXPECT_EQ(parsed(waiting.receive()).status, 409);
    EXPECT_GT(std::chrono::steady_clock::now() - begin, 4s) << "or nothing hung";
    EXPECT_TRUE(faults().empty()) << "a thumbnail is no fault of the look";
}

TEST_F(ServeCrash, AProcessThatCannotBeginAgainIsAnErrorOfThePictureAlone) {
    start();
    const std::string first = get("/api/picture?frame=1").body;
    std::filesystem::rename(folder_ / "in_0001.exr", folder_ / "away");
    kill(drawer(), SIGKILL);
    EXPECT_GE(get("/api/picture?frame=1").status, 400);
    ASSERT_EQ(set(2).status, 200);
    std::filesystem::rename(folder_ / "away", folder_ / "in_0001.exr");
    ASSERT_EQ(post("/api/undo").status, 200);
    EXPECT_EQ(get("/api/picture?frame=1").body, first);
}

}  // namespace
}  // namespace aftershade::test
