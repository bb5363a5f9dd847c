// The program itself over real sockets: what it answers to its page, and to those that are not its page.
#include <algorithm>
#include <chrono>
#include <csignal>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "framework/capture/capture_writer.h"
#include "framework/file/png_file.h"
#include "framework/image/role.h"
#include "tests/cli/command.h"
#include "tests/serve/client.h"
#include "tests/synthetic_capture.h"

namespace aftershade::test {
namespace {

using namespace std::chrono_literals;

const std::string kLook = R"({ "aftershade": 1,
  // by eye
  "steps": [
    { "effect": "vignette" },
    { "effect": "view_transform", "params": { "exposure": 0.5 } }
  ] }
)";

class Serve : public ::testing::Test {
protected:
    void start(std::vector<std::string> more = {}) {
        SyntheticScene scene{
            .width = 64, .height = 36, .background = {0.1f, 0.2f, 0.4f}, .background_depth_m = 8};
        scene.box = SyntheticBox{4, 6, 16, 12, 5, 2};
        Capture capture = make_capture(scene, 1);
        if (has_nan_) capture.images.at(kColorRole).at(3, 2, 1) = std::numeric_limits<float>::quiet_NaN();
        write_capture(capture, folder_ / "in_0001.exr");
        write_text(folder_ / "look.json", kLook);
        write_text(folder_ / "secret.txt", "secret");
        std::vector<std::string> words{"serve", "look.json", "in_0001.exr", "--backend", "osmesa"};
        words.insert(words.end(), more.begin(), more.end());
        command_.emplace(aftershade_words(words), folder_.path());
        ASSERT_TRUE(command_->wait_for_lines(1)) << command_->wait().err;
        const std::string address = command_->printed();
        const std::size_t colon = address.rfind(':'), hash = address.find("/#token=");
        ASSERT_TRUE(address.starts_with("http://127.0.0.1:") && hash != std::string::npos) << address;
        port_ = std::stoi(address.substr(colon + 1, hash - colon - 1));
        token_ = address.substr(hash + 8, 32);
    }

    std::string host() const { return "127.0.0.1:" + std::to_string(port_); }
    Answer ask(const std::string& bytes) const {
        const Client client(port_);
        client.send(bytes);
        return parsed(client.receive());
    }
    std::string head(const std::string& line, const std::string& more = "") const {
        return line + " HTTP/1.1\r\nHost: " + host() + "\r\nX-Aftershade-Token: " + token_ + "\r\n" + more;
    }
    Answer get(const std::string& path) const { return ask(head("GET " + path) + "\r\n"); }
    Answer post(const std::string& path, const std::string& body = "") const {
        return ask(head("POST " + path, "Content-Length: " + std::to_string(body.size()) + "\r\n") + "\r\n" +
                   body);
    }
    Answer set(double value, int step = 1, const char* param = "exposure") const {
        const Json state = get("/api/state").json();
        return post("/api/edit",
                    Json{{"revision", state["revision"]},
                         {"edits", {{{"op", "set"}, {"step", step}, {"param", param}, {"value", value}}}}}
                        .dump());
    }
    Json times(const std::string& query = "") const {
        return Json::parse(get("/api/picture?frame=1" + query).header("X-Aftershade-Times"));
    }
    int ended_by(int signal) {
        command_->send(signal);
        return command_->wait().exit_code;
    }

    TemporaryFolder folder_;
    std::optional<Command> command_;
    bool has_nan_ = false;
    int port_ = 0;
    std::string token_;
};

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
    EXPECT_GE(drawn, 2) << "the first, which had begun, and the newest";
    EXPECT_GE(dropped, 1);
    EXPECT_EQ(drawn + dropped, kRequests);
}

const std::string kTint =
    R"({ "aftershade": 1, "id": "tint", "version": "1.0.0", "summary": "Multiplies the colour.",
  "inputs": { "color": { "role": "color", "doc": "Any." } },
  "outputs": { "color": { "role": "color", "doc": "The same, tinted." } },
  "passes": [ { "name": "tint", "shader": "tint.frag", "reads": ["color"], "writes": ["color"] } ] }
)";
std::string tint_shader(const std::string& expression) {
    return "#version 450 core\n#include <pass>\n\nvoid main() {\n    vec4 light = texelFetch(color, "
           "ivec2(gl_FragCoord.xy), 0);\n    out_color = " +
           expression + ";\n}\n";
}

class ServeShaders : public Serve {
protected:
    void start_with_tint(std::vector<std::string> more = {}) {
        std::filesystem::create_directories(folder_ / "effects/tint");
        write_text(folder_ / "effects/tint/effect.json", kTint);
        write_text(folder_ / "effects/tint/tint.frag", tint_shader("light"));
        write_text(folder_ / "effects/secret.frag", "secret");
        std::filesystem::create_symlink(folder_ / "secret.txt", folder_ / "effects/tint/link.frag");
        more.insert(more.begin(), {"--effect-path", "effects"});
        start(more);
        const Json state = get("/api/state").json();
        const Json edit = {{"op", "add"}, {"at", 0}, {"effect", "tint"}};
        ASSERT_EQ(post("/api/edit", Json{{"revision", state["revision"]}, {"edits", {edit}}}.dump()).status,
                  200);
    }
    Answer save(const std::string& before, const std::string& text, const std::string& file = "tint.frag",
                const std::string& effect = "tint") const {
        return post("/api/shader",
                    Json{{"effect", effect}, {"file", file}, {"before", before}, {"text", text}}.dump());
    }
    std::string shader_on_disk() const { return read_text(folder_ / "effects/tint/tint.frag"); }
};

TEST_F(ServeShaders, WritesAShaderOfTheUsersEffectAndDrawsWithIt) {
    start_with_tint();
    const std::string first = get("/api/picture?frame=1").body;
    EXPECT_EQ(get("/api/shaders?effect=tint").json()["files"], (Json{{"tint.frag", tint_shader("light")}}))
        << "a link is no shader of the effect";
    const std::string green = tint_shader("light * vec4(0.0, 2.0, 0.0, 1.0)");
    ASSERT_EQ(save(tint_shader("light"), green).status, 200);
    EXPECT_EQ(shader_on_disk(), green);
    const Answer drawn = get("/api/picture?frame=1");
    ASSERT_EQ(drawn.status, 200) << drawn.body;
    write_text(folder_ / "shown.png", drawn.body);
    ASSERT_EQ(post("/api/save").status, 200);
    const CommandResult run = run_aftershade(
        {"run", "look.json", "in_0001.exr", "--effect-path", "effects", "-o", "out.png"}, folder_.path());
    ASSERT_EQ(run.exit_code, 0) << run.err;
    EXPECT_TRUE(
        std::ranges::equal(read_png(folder_ / "shown.png").floats(), read_png(folder_ / "out.png").floats()));
    ASSERT_EQ(save(green, tint_shader("light")).status, 200);
    EXPECT_EQ(get("/api/picture?frame=1").body, first);
}

TEST_F(ServeShaders, GivesTheFileAndLineOfAFaultAndDrawsAgainOnceItIsMended) {
    start_with_tint();
    const std::string first = get("/api/picture?frame=1").body;
    ASSERT_EQ(save(tint_shader("light"), tint_shader("lihgt")).status, 200);
    for (int attempt = 0; attempt < 2; ++attempt) {
        const Answer refused = get("/api/picture?frame=1");
        EXPECT_EQ(refused.status, 400);
        EXPECT_NE(refused.body.find("effects/tint/tint.frag:6:"), std::string::npos) << refused.body;
    }
    ASSERT_EQ(save(tint_shader("lihgt"), tint_shader("light")).status, 200);
    EXPECT_EQ(get("/api/picture?frame=1").body, first);
}

TEST_F(ServeShaders, FollowsFilesThatAnotherProgramChanges) {
    start_with_tint();
    const std::string first = get("/api/picture?frame=1").body;
    const Json before = get("/api/changes").json();
    EXPECT_EQ(get("/api/changes").json(), before);
    write_text(folder_ / "effects/tint/tint.frag", tint_shader("0.25 * light"));
    EXPECT_NE(get("/api/changes").json(), before);
    EXPECT_NE(get("/api/picture?frame=1").body, first);
    EXPECT_EQ(save(tint_shader("light"), "mine").status, 409) << "it holds what another program wrote";
    EXPECT_EQ(shader_on_disk(), tint_shader("0.25 * light"));
    std::string manifest = kTint;
    manifest.replace(manifest.find("Multiplies"), 10, "Dims up to");
    write_text(folder_ / "effects/tint/effect.json", manifest);
    get("/api/changes");
    EXPECT_NE(get("/api/effects").body.find("Dims up to the colour."), std::string::npos);
    EXPECT_EQ(get("/api/picture?frame=1").status, 200);
}

TEST_F(ServeShaders, WritesNoFileButTheShadersOfTheUsersEffects) {
    start_with_tint();
    const auto before = contents(folder_.path());
    for (const char* file : {"effect.json", "new.frag", "../secret.frag", "../../secret.txt", "link.frag", "",
                             "/etc/passwd", "cases/x.frag"})
        EXPECT_EQ(save("secret", "mine", file).status, 404) << file;
    EXPECT_EQ(save("", "mine", "tint.frag", "../effects/tint").status, 404);
    const Json shipped = get("/api/shaders?effect=vignette").json();
    const std::string name = shipped["files"].begin().key();
    const Json text = shipped["files"].begin().value();
    const Answer refused = save(text.get<std::string>(), text.get<std::string>(), name, "vignette");
    EXPECT_EQ(refused.status, 403) << "it comes with the program";
    EXPECT_NE(refused.body.find("--effect-path"), std::string::npos);
    EXPECT_EQ(post("/api/shader", "{}").status, 400);
    EXPECT_EQ(ask("POST /api/shader HTTP/1.1\r\nHost: " + host() + "\r\nContent-Length: 2\r\n\r\n{}").status,
              401);
    EXPECT_EQ(
        ask(head("POST /api/shader", "Origin: http://attacker.example\r\nContent-Length: 2\r\n") + "\r\n{}")
            .status,
        403);
    EXPECT_EQ(contents(folder_.path()), before);
}

TEST_F(ServeShaders, WritesNoShaderWithReadOnly) {
    start_with_tint({"--read-only"});
    EXPECT_EQ(save(tint_shader("light"), "mine").status, 403);
    EXPECT_EQ(shader_on_disk(), tint_shader("light"));
}

TEST_F(ServeShaders, MakesANewEffectAsTheCommandDoesAndOverwritesNothing) {
    start_with_tint();
    const auto make = [&](const std::string& effect, const std::string& folder = "effects") {
        return post("/api/effect", Json{{"folder", folder}, {"effect", effect}}.dump());
    };
    const auto before = contents(folder_.path());
    for (const char* id : {"", "Glow", "../glow", "glow/x", "/tmp/glow", ".", "a b", "g\u00fc"})
        EXPECT_EQ(make(id).status, 400) << id;
    EXPECT_EQ(make(std::string(65, 'g')).status, 400);
    EXPECT_EQ(make("tint").status, 409) << "it is there";
    EXPECT_EQ(make("vignette").status, 409) << "it comes with the program";
    for (const char* folder : {"", ".", "..", "/tmp", "effects/tint", "effects/../effects"})
        EXPECT_EQ(make("glow", folder).status, 403) << folder;
    EXPECT_EQ(post("/api/effect", "[]").status, 400);
    EXPECT_EQ(contents(folder_.path()), before);

    std::filesystem::create_symlink("nowhere", folder_ / "effects/hanging");
    EXPECT_EQ(make("hanging").status, 409) << "a link that leads nowhere is overwritten neither";
    ASSERT_EQ(make("glow").status, 200);
    EXPECT_NE(get("/api/effects").body.find("\"glow\""), std::string::npos);
    ASSERT_EQ(run_aftershade({"new", "glow", "--path", "made"}, folder_.path()).exit_code, 0);
    for (const char* file : {"effect.json", "glow.frag", "look.json"})
        EXPECT_EQ(read_text(folder_ / "effects/glow" / file), read_text(folder_ / "made/glow" / file));
    EXPECT_EQ(make("glow").status, 409);
}

TEST_F(ServeShaders, MakesNoEffectWithReadOnly) {
    start_with_tint({"--read-only"});
    EXPECT_EQ(post("/api/effect", R"({"folder": "effects", "effect": "glow"})").status, 403);
    EXPECT_FALSE(std::filesystem::exists(folder_ / "effects/glow"));
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

TEST_F(Serve, CountsTheNanOfTheFinalPicture) {
    has_nan_ = true;
    start();
    const Json state = get("/api/state").json();
    const Json edit = {{"op", "text"},
                       {"value", R"({ "aftershade": 1, "steps": [{ "effect": "vignette" }] })"}};
    ASSERT_EQ(post("/api/edit", Json{{"revision", state["revision"]}, {"edits", {edit}}}.dump()).status, 200);
    EXPECT_EQ(times()["non_finite"], 1);
}

TEST_F(ServeShaders, EndsWithItsSecondProcessAtAnInterrupt) {
    start_with_tint();
    EXPECT_EQ(get("/api/picture?frame=1").status, 200);
    EXPECT_EQ(ended_by(SIGINT), 130);
    EXPECT_FALSE(Client(port_).is_open());
}

TEST_F(Serve, WritesNothingWithReadOnly) {
    start({"--read-only"});
    ASSERT_EQ(set(2).status, 200);
    EXPECT_EQ(post("/api/save").status, 403);
    EXPECT_EQ(read_text(folder_ / "look.json"), kLook);
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
