// The program itself over real sockets: what it answers to its page, and to those that are not its page.
#include <algorithm>
#include <chrono>
#include <csignal>
#include <memory>
#include <string>
#include <vector>

#include "framework/file/png_file.h"
#include "tests/serve/serve_fixture.h"

namespace aftershade::test {
namespace {

using namespace std::chrono_literals;

TEST_F(Serve, AnswersItsPageAndEndsWithTheCodeOfAnInterrupt) {
    start();
    EXPECT_EQ(ask("GET / HTTP/1.1\r\nHost: " + host() + "\r\n\r\n").status, 200) << "the page needs no token";
    const Json state = get("/api/state").json();
    EXPECT_EQ(state["steps"].size(), 2u);
    EXPECT_EQ(state["steps"][1]["params"]["exposure"]["effective"], 0.5);
    EXPECT_EQ(state["steps"][1]["params"]["exposure"]["from"], "look");
    EXPECT_EQ(state["capture"]["width"], 64);
    EXPECT_GT(get("/api/effects").json().size(), 3u);
    const Answer picture = get("/api/picture?frame=1");
    EXPECT_EQ(picture.status, 200) << picture.body;
    EXPECT_TRUE(picture.body.starts_with("\x89PNG"));
    const Json probe = get("/api/probe?frame=1&x=5&y=7").json();
    EXPECT_EQ(probe["result"].size(), 4u);
    std::uint64_t pixels = 0;
    const Json histogram = get("/api/histogram?frame=1").json();
    for (const Json& count : histogram["r"]) pixels += count.get<std::uint64_t>();
    EXPECT_EQ(pixels, 64u * 36u);
    EXPECT_NE(get("/api/command").json()["command"].get<std::string>().find("aftershade run "),
              std::string::npos);
    EXPECT_EQ(ended_by(SIGINT), 130);
}

TEST_F(Serve, DrawsTheStepsFromTheChangedOneOnAndTheSameBits) {
    start();
    EXPECT_EQ(times()["steps_drawn"], 2);
    EXPECT_EQ(times()["steps_drawn"], 0) << "nothing changed";
    struct Change {
        int step;
        const char* param;
        double value;
    };
    for (const Change& change :
         {Change{1, "exposure", 1.25}, Change{0, "strength", 0.8}, Change{1, "exposure", -0.5},
          Change{0, "strength", 0.1}, Change{1, "exposure", 0.5}}) {
        ASSERT_EQ(set(change.value, change.step, change.param).status, 200);
        const Json after = times();
        EXPECT_EQ(after["steps_drawn"], 2 - change.step);
        EXPECT_EQ(after["steps_cached"], change.step);
        write_text(folder_ / "cached.png", get("/api/picture?frame=1").body);
        ASSERT_EQ(post("/api/save").status, 200);
        const CommandResult run =
            run_aftershade({"run", "look.json", "in_0001.exr", "-o", "out.png"}, folder_.path());
        ASSERT_EQ(run.exit_code, 0) << run.err;
        const Image shown = read_png(folder_ / "cached.png"), written = read_png(folder_ / "out.png");
        ASSERT_EQ(shown.width(), written.width());
        EXPECT_TRUE(std::ranges::equal(shown.floats(), written.floats()))
            << change.param << " " << change.value;
    }
}

TEST_F(Serve, DrawsTheBitsOfARunWherePixelsAreNotSquareToo) {
    pixel_aspect_ = 1.5f;
    start();
    const auto expect_bits_of_run = [&] {
        write_text(folder_ / "shown.png", get("/api/picture?frame=1").body);
        const CommandResult run =
            run_aftershade({"run", "look.json", "in_0001.exr", "-o", "out.png"}, folder_.path());
        ASSERT_NE(run.err.find("works on 96 x 36 square pixels"), std::string::npos) << run.err;
        const Image shown = read_png(folder_ / "shown.png"), written = read_png(folder_ / "out.png");
        EXPECT_EQ(shown.width(), 64);
        EXPECT_TRUE(std::ranges::equal(shown.floats(), written.floats()));
    };
    expect_bits_of_run();
    ASSERT_EQ(set(0.8, 0, "strength").status, 200);
    ASSERT_EQ(post("/api/save").status, 200);
    expect_bits_of_run();
    ASSERT_EQ(set(1.25).status, 200);
    ASSERT_EQ(post("/api/save").status, 200);
    expect_bits_of_run();
}

TEST_F(Serve, HoldsAsManyGlObjectsAfterTheSameEditsAgain) {
    start();
    const auto objects_after_edits = [&] {
        for (const double value : {0.1, 0.9, 0.5}) {
            set(value);
            for (const char* scale : {"4", "2", "1"}) times(std::string("&scale=") + scale);
            times("&view=role:depth");
        }
        return times()["gl_objects"].get<int>();
    };
    const int first = objects_after_edits();
    EXPECT_GT(first, 5);
    EXPECT_EQ(objects_after_edits(), first);
    EXPECT_EQ(objects_after_edits(), first);
}

TEST_F(Serve, SavesTheLookAloneAndKeepsItsComments) {
    start();
    const auto before = contents(folder_.path());
    ASSERT_EQ(set(2).status, 200);
    EXPECT_EQ(contents(folder_.path()), before) << "nothing is written before it is saved";
    ASSERT_EQ(post("/api/save").status, 200);
    auto expected = before;
    expected["look.json"].replace(expected["look.json"].find("0.5"), 3, "2.0");
    EXPECT_EQ(contents(folder_.path()), expected);
    ASSERT_EQ(post("/api/undo").status, 200);
    ASSERT_EQ(post("/api/save").status, 200);
    EXPECT_EQ(contents(folder_.path()), before);
    EXPECT_EQ(post("/api/edit", R"({"revision": 1, "edits": []})").status, 409);
}

TEST_F(Serve, DrawsTheNewestOfManyRequestsAndLetsTheOlderOnesGo) {
    start();
    std::vector<std::unique_ptr<Client>> clients;
    constexpr int kRequests = 24;
    for (int i = 0; i < kRequests; ++i) {
        clients.push_back(std::make_unique<Client>(port_));
        clients.back()->send(head("GET /api/picture?frame=1&exposure=" + std::to_string(i)) + "\r\n");
    }
    int drawn = 0, dropped = 0;
    for (const auto& client : clients) {
        const Answer answer = parsed(client->receive());
        if (answer.status == 200) ++drawn;
        else if (answer.status == 204 && answer.body.empty()) ++dropped;
    }
    // The first is among them only if its drawing began before the others came.
    EXPECT_GE(drawn, 1) << "the newest";
    EXPECT_GE(dropped, 1);
    EXPECT_EQ(drawn + dropped, kRequests);
}

TEST_F(Serve, FollowsALookThatAnotherProgramEmptiesAndWritesAgain) {
    start();
    const std::string first = get("/api/picture?frame=1").body;
    write_text(folder_ / "look.json", "");
    get("/api/changes");
    const Json emptied = get("/api/state").json();
    EXPECT_EQ(emptied["text"], "");
    ASSERT_FALSE(emptied["faults"].empty());
    EXPECT_EQ(emptied["faults"][0]["line"], 1);
    const Answer kept = get("/api/picture?frame=1");
    EXPECT_EQ(kept.status, 200);
    EXPECT_EQ(kept.body, first) << "the last good picture stays";
    write_text(folder_ / "look.json", kLook);
    get("/api/changes");
    EXPECT_TRUE(get("/api/state").json()["faults"].empty());
    EXPECT_EQ(get("/api/picture?frame=1").body, first);

    ASSERT_EQ(set(0.75).status, 200);
    write_text(folder_ / "look.json", "");
    get("/api/changes");
    EXPECT_NE(get("/api/state").json()["text"], "") << "what is not saved is not overwritten";
    EXPECT_EQ(post("/api/save").status, 409);
}

TEST_F(Serve, ShowsTheCaptureAloneWhileTheLookHasHadFaultsFromTheStart) {
    look_ = "";
    start();
    const Json empty = get("/api/state").json();
    ASSERT_FALSE(empty["faults"].empty());
    EXPECT_EQ(empty["is_capture_alone"], true);
    const Answer picture = get("/api/picture?frame=1");
    ASSERT_EQ(picture.status, 200) << picture.body;
    EXPECT_EQ(picture.body, get("/api/picture?frame=1&view=before").body);
    EXPECT_EQ(get("/api/picture?frame=1&view=role:depth&scale=4").status, 200);
    EXPECT_EQ(get("/api/histogram?frame=1").status, 200);
    EXPECT_EQ(get("/api/probe?frame=1&x=1&y=1").status, 200);
    ASSERT_EQ(edit({{"op", "text"}, {"value", kLook}}).status, 200);
    const Json filled = get("/api/state").json();
    EXPECT_TRUE(filled["faults"].empty());
    EXPECT_EQ(filled["is_capture_alone"], false);
    EXPECT_NE(get("/api/picture?frame=1").body, picture.body);
}

TEST_F(Serve, SaysWhereATableNamesAnObjectThatTheCaptureHasNoNamesFor) {
    start();
    ASSERT_EQ(edit({{"op", "add"}, {"at", 0}, {"effect", "motion_blur"}}).status, 200);
    const Json rows = Json::parse(R"({"default": {"scale": 1}, "rows": [{"name": "Lamp", "scale": 0}]})");
    ASSERT_EQ(edit({{"op", "set"}, {"step", 0}, {"param", "objects"}, {"value", rows}}).status, 200);
    for (const char* request :
         {"picture?frame=1", "picture?frame=1&scale=4", "histogram?frame=1", "probe?frame=1&x=1&y=1"}) {
        const Answer answer = get(std::string("/api/") + request);
        EXPECT_EQ(answer.status, 400) << request;
        EXPECT_NE(answer.body.find("'Lamp'"), std::string::npos) << answer.body;
    }
    ASSERT_EQ(post("/api/undo").status, 200);
    EXPECT_EQ(get("/api/picture?frame=1").status, 200);
}

TEST_F(Serve, PlaysFramesOfAnEffectWithHistoryInTheirOrderAndElseBeginsWithEach) {
    frames_ = 3;
    look_ = R"({ "aftershade": 1, "steps": [ { "effect": "trail" }, { "effect": "view_transform" } ] })";
    std::filesystem::create_directories(folder_ / "effects/trail");
    write_text(folder_ / "effects/trail/effect.json",
               R"({ "aftershade": 1, "id": "trail", "version": "1.0.0", "summary": "Blends frames.",
  "inputs": { "color": { "role": "color", "doc": "Any." } },
  "outputs": { "color": { "role": "color", "doc": "Half of it is of the frames before." } },
  "textures": { "kept": { "format": "rgba32f", "history": true, "doc": "The output." } },
  "passes": [ { "name": "trail", "shader": "trail.frag", "reads": ["color", "kept.prev"],
                "writes": ["color", "kept"] } ] }
)");
    write_text(folder_ / "effects/trail/trail.frag", R"(#version 450 core
#include <pass>

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    vec4 now = texelFetch(color, at, 0);
    if (frame.history_valid) now = mix(now, texelFetch(kept_prev, at, 0), 0.5);
    out_color = out_kept = now;
}
)");
    start({"--effect-path", "effects"});
    const auto shown = [&](int frame, const char* more) {
        const Answer answer = get("/api/picture?frame=" + std::to_string(frame) + more);
        EXPECT_EQ(answer.status, 200) << answer.body;
        write_text(folder_ / "shown.png", answer.body);
        const Image image = read_png(folder_ / "shown.png");
        return std::vector<float>(image.floats().begin(), image.floats().end());
    };
    const auto run = [&](const std::string& frames) {
        const CommandResult done =
            run_aftershade({"run", "look.json", "in_####.exr", "--effect-path", "effects", "--frames", frames,
                            "-o", "out_####.png", "--overwrite"},
                           folder_.path());
        EXPECT_EQ(done.exit_code, 0) << done.err;
        const Image image = read_png(folder_ / "out_0003.png");
        // The pictures of a run of several frames all have an alpha where the first frame has.
        std::vector<float> colors;
        for (int y = 0; y < image.height(); ++y)
            for (int x = 0; x < image.width(); ++x)
                for (int c = 0; c < 3; ++c) colors.push_back(image.at(x, y, c));
        return colors;
    };
    const std::vector<float> in_order = run("1-3");
    std::filesystem::remove(folder_ / "out_0003.png");
    const std::vector<float> alone = run("3");
    ASSERT_NE(in_order, alone);
    for (int frame = 1; frame <= 3; ++frame) {
        const std::vector<float> played = shown(frame, "&continues=1");
        if (frame == 3) {
            EXPECT_EQ(played, in_order);
        }
    }
    EXPECT_EQ(shown(3, ""), in_order) << "what is shown stays";
    shown(1, "");
    EXPECT_EQ(shown(3, "&continues=1"), alone) << "frame 2 was left out";
    shown(2, "");
    EXPECT_EQ(shown(3, ""), alone) << "a frame that is looked up begins with itself";
}

TEST_F(Serve, GivesPngsThatAreSrgbWhereTheyArePictures) {
    start();
    const auto is_srgb = [&](const std::string& view) {
        return get("/api/picture?frame=1&view=" + view).body.find("sRGB") != std::string::npos;
    };
    EXPECT_TRUE(is_srgb("final"));
    EXPECT_TRUE(is_srgb("before"));
    EXPECT_TRUE(is_srgb("role:color"));
    EXPECT_FALSE(is_srgb("role:depth")) << "false colours";
    write_text(folder_ / "shown.png", get("/api/picture?frame=1").body);
    EXPECT_EQ(read_png(folder_ / "shown.png").width(), 64) << "whose chunks are whole";
}

TEST_F(Serve, CountsTheNanOfTheFinalPicture) {
    has_nan_ = true;
    start();
    const Json state = get("/api/state").json();
    const Json edit = {{"op", "text"},
                       {"value", R"({ "aftershade": 1, "steps": [{ "effect": "vignette" }] })"}};
    ASSERT_EQ(post("/api/edit", Json{{"revision", state["revision"]}, {"edits", {edit}}}.dump()).status, 200);
    EXPECT_EQ(times()["non_finite"], 1);
}

TEST_F(Serve, RefusesWhoeverIsNotItsPage) {
    start();
    const std::string token = "\r\nX-Aftershade-Token: " + token_;
    const auto request = [](const std::string& more) {
        return "GET /api/state HTTP/1.1\r\n" + more + "\r\n\r\n";
    };
    EXPECT_EQ(ask(request("Host: " + host())).status, 401);
    EXPECT_EQ(ask(request("Host: " + host() + "\r\nX-Aftershade-Token: " + std::string(32, '0'))).status,
              401);
    EXPECT_EQ(ask(request("Host: " + host() + "\r\nX-Aftershade-Token: " + token_.substr(1))).status, 401);
    EXPECT_EQ(ask(request("Host: attacker.example:" + std::to_string(port_) + token)).status, 421)
        << "a name that was made to lead here";
    EXPECT_EQ(ask(request("X-Aftershade-Token: " + token_)).status, 421);
    EXPECT_EQ(ask(request("Host: " + host() + token + "\r\nOrigin: http://attacker.example")).status, 403);
    EXPECT_EQ(ask(request("Host: " + host() + token + "\r\nOrigin: null")).status, 403);
    EXPECT_EQ(ask(request("Host: " + host() + token + "\r\nSec-Fetch-Site: cross-site")).status, 403);
    EXPECT_EQ(ask(request("Host: " + host() + token + "\r\nOrigin: http://" + host())).status, 200);
    EXPECT_EQ(ask(request("Host: " + host() + "\r\nHost: attacker.example" + token)).status, 400);
}

TEST_F(Serve, GivesNoFileThatIsNotOfThePage) {
    start();
    for (const char* path :
         {"/secret.txt", "/../secret.txt", "/..%2fsecret.txt", "/%2e%2e/%2e%2e/etc/passwd", "//etc/passwd",
          "/page/../CMakeLists.txt", "/index.html/../../README.md", "/api/../index.html", "/.git/config"}) {
        const Answer answer = get(path);
        EXPECT_EQ(answer.status, 404) << path;
        EXPECT_EQ(answer.body.find("secret\n"), std::string::npos);
    }
    for (const char* view : {"role:../../x", "tap:a.b", "tap:", "role:", "nothing"})
        EXPECT_EQ(get(std::string("/api/picture?view=") + view).status, 400) << view;
    EXPECT_EQ(get("/api/picture?frame=2").status, 404);
    EXPECT_EQ(get("/api/picture?frame=x").status, 400);
}

TEST_F(Serve, LetsThePageRunItsOwnScriptsAlone) {
    start();
    for (const char* path : {"/", "/api/state", "/nothing"}) {
        const Answer answer = get(path);
        const std::string policy = answer.header("Content-Security-Policy");
        EXPECT_TRUE(
            policy.starts_with("default-src 'none'; script-src 'self'; style-src 'self'; "
                               "img-src 'self' blob:; connect-src 'self'"))
            << policy;
        EXPECT_EQ(policy.find("unsafe"), std::string::npos);
        EXPECT_EQ(answer.header("X-Content-Type-Options"), "nosniff");
        EXPECT_EQ(answer.header("Cache-Control"), "no-store");
        EXPECT_EQ(answer.header("Access-Control-Allow-Origin"), "");
    }
}

TEST_F(Serve, RefusesBodiesAndHeadsThatAreTooLongAtOnce) {
    start();
    EXPECT_EQ(ask(head("POST /api/edit", "Content-Length: 1073741824\r\n\r\n")).status, 413);
    EXPECT_EQ(ask(head("POST /api/edit", "Content-Length: 99999999999999999999999\r\n\r\n")).status, 413);
    EXPECT_EQ(ask(head("POST /api/edit", "Content-Length: -1\r\n\r\n")).status, 400);
    EXPECT_EQ(ask(head("POST /api/edit", "Transfer-Encoding: chunked\r\n\r\n")).status, 411);
    EXPECT_EQ(ask(head("GET /", "X-Long: " + std::string(20'000, 'x') + "\r\n\r\n")).status, 431);
    EXPECT_EQ(post("/api/edit", std::string(200'000, '[')).status, 400);
    EXPECT_EQ(ask("nonsense\r\n\r\n").status, 400);
    EXPECT_EQ(get("/api/state").status, 200);
}

TEST_F(Serve, AnswersBesideAThousandConnectionsThatSendNothingOrSlowly) {
    start();
    std::vector<std::unique_ptr<Client>> idle;
    for (int i = 0; i < 1000; ++i) {
        idle.push_back(std::make_unique<Client>(port_));
        if (i % 2 == 0) idle.back()->send(head("POST /api/edit", "Content-Length: 1000\r\n\r\n{"));
    }
    const auto start = std::chrono::steady_clock::now();
    EXPECT_EQ(get("/api/state").status, 200);
    EXPECT_LT(std::chrono::steady_clock::now() - start, 5s);
    idle.clear();
    EXPECT_EQ(get("/api/state").status, 200);
}

}  // namespace
}  // namespace aftershade::test
