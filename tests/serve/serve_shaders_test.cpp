// Shaders of the user's effects over real sockets: read, written, followed on disk, created.
#include <algorithm>
#include <csignal>
#include <filesystem>
#include <string>
#include <vector>

#include "framework/file/png_file.h"
#include "tests/serve/serve_fixture.h"

namespace aftershade::test {
namespace {

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

TEST_F(ServeShaders, CreatesANewEffectLikeTheCommandAndOverwritesNothing) {
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

TEST_F(ServeShaders, EndsWithItsSecondProcessAtAnInterrupt) {
    start_with_tint();
    EXPECT_EQ(get("/api/picture?frame=1").status, 200);
    EXPECT_EQ(ended_by(SIGINT), 130);
    EXPECT_FALSE(Client(port_).is_open());
}

}  // namespace
}  // namespace aftershade::test
