// Where the files of strangers' effects, suites, meshes and reports may lie: docs/reliability.md#files.
#include <sys/stat.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "framework/batch/process_codes.h"
#include "tests/cli/batch_work.h"

namespace aftershade::test {
namespace {

namespace fs = std::filesystem;

class UntrustedFiles : public BatchWork {
protected:
    UntrustedFiles() {
        write_frames(1, 1, 16, 9);
        write_text(folder_ / "secret.glsl", "#error this is secret\n");
    }
    CommandResult check_effect(const std::string& id, std::vector<std::string> more = {},
                               const Environment& environment = {}) {
        more.insert(more.begin(), {"check", "effects/" + id, "--no-gl"});
        return run_aftershade(more, folder_.path(), environment);
    }
};

TEST_F(UntrustedFiles, OfAnEffectAreReadOnlyFromItsFolder) {
    EXPECT_EQ(check_effect("spread").exit_code, 0);
    const std::string text = read_text(folder_ / "effects/spread/main.frag");
    write_text(folder_ / "outside.frag", text);
    fs::remove(folder_ / "effects/spread/main.frag");
    fs::create_symlink("../../outside.frag", folder_ / "effects/spread/main.frag");
    const CommandResult refused = check_effect("spread");
    EXPECT_EQ(refused.exit_code, 1) << refused.err;
    EXPECT_NE(refused.err.find("main.frag leads out of the folder"), std::string::npos) << refused.err;
    EXPECT_NE(refused.err.find("(move it there, or allow its folder with --allow-path)"), std::string::npos)
        << refused.err;
    EXPECT_EQ(check_effect("spread", {"--allow-path", "."}).exit_code, 0);
    EXPECT_EQ(check_effect("spread", {}, {{"AFTERSHADE_ALLOW_PATH", folder_.path().string()}}).exit_code, 0);
    run({"spread.json", "in_0001.exr", "-o", "out.exr"}, int(ExitCode::effect));
    EXPECT_FALSE(fs::exists(folder_ / "out.exr"));
    run({"spread.json", "in_0001.exr", "-o", "out.exr", "--allow-path", "."}, 0);
}

TEST_F(UntrustedFiles, ThatAShaderIncludesThroughALinkAreNotShown) {
    const std::string text = read_text(folder_ / "effects/spread/main.frag");
    write_text(folder_ / "effects/spread/main.frag", text.substr(0, text.find("void main")) +
                                                         "#include \"more.glsl\"\n" +
                                                         text.substr(text.find("void main")));
    fs::create_symlink("../../secret.glsl", folder_ / "effects/spread/more.glsl");
    const CommandResult result = run({"spread.json", "in_0001.exr", "-o", "out.exr"}, int(ExitCode::effect));
    EXPECT_NE(result.err.find("more.glsl leads out of the folder"), std::string::npos) << result.err;
    EXPECT_EQ(result.err.find("this is secret"), std::string::npos) << result.err;
}

TEST_F(UntrustedFiles, ThatAManifestNamesAsPicturesLieInItsFolder) {
    const fs::path manifest = folder_ / "effects/spread/effect.json";
    auto document = nlohmann::ordered_json::parse(read_text(manifest));
    document["params"]["noise"] = {
        {"type", "file"}, {"kind", "image"}, {"default", "noise.exr"}, {"doc", "A picture."}};
    write_text(manifest, document.dump(2));
    fs::create_symlink("../../in_0001.exr", folder_ / "effects/spread/noise.exr");
    const CommandResult result = check_effect("spread");
    EXPECT_EQ(result.exit_code, 1) << result.err;
    EXPECT_NE(result.err.find("params.noise: "), std::string::npos) << result.err;
    EXPECT_NE(result.err.find("noise.exr leads out of the folder"), std::string::npos) << result.err;
}

TEST_F(UntrustedFiles, OfASuiteAreApprovedOnlyInItsFolder) {
    fs::create_directory(folder_ / "suite");
    write_text(folder_ / "suite/golden.json", R"({ "aftershade": 1, "goldens": "../..", "cases": [
        { "name": "still", "steps": [], "capture": "../in_0001.exr" } ] })");
    const CommandResult result = run_aftershade({"golden", "approve", "suite"}, folder_.path());
    EXPECT_EQ(result.exit_code, 64) << result.err;
    EXPECT_NE(result.err.find("suite/golden.json:1:"), std::string::npos) << result.err;
    EXPECT_NE(result.err.find("the folder 'suite/../..' leads out of the folder 'suite'"), std::string::npos)
        << result.err;
}

TEST_F(UntrustedFiles, OfAMeshLieInItsFolder) {
    fs::create_directory(folder_ / "meshes");
    write_text(folder_ / "points.bin", std::string(36, '\0'));
    const auto mesh = [](const std::string& uri) {
        return R"({ "asset": { "version": "2.0" }, "buffers": [ { "byteLength": 36, "uri": ")" + uri +
               R"(" } ],
            "bufferViews": [ { "buffer": 0, "byteLength": 36 } ],
            "accessors": [ { "bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3" } ],
            "meshes": [ { "primitives": [ { "attributes": { "POSITION": 0 } } ] } ],
            "nodes": [ { "mesh": 0 } ], "scenes": [ { "nodes": [ 0 ] } ] })";
    };
    write_text(folder_ / "meshes/m.gltf", mesh("../points.bin"));
    auto scene = nlohmann::json::parse(read_text(AFTERSHADE_SOURCE_DIR "/scenes/plane_edge/scene.json"),
                                       nullptr, true, true);
    scene["meshes"]["m"] = {{"file", "meshes/m.gltf"}};
    write_text(folder_ / "scene.json", scene.dump());
    const std::vector<std::string> render{"render", "scene.json", "-o", "set", "--size", "8x8"};
    const CommandResult refused = run_aftershade(render, folder_.path());
    EXPECT_EQ(refused.exit_code, 2) << refused.err;
    EXPECT_NE(refused.err.find("leads out of the folder 'meshes'"), std::string::npos) << refused.err;
    auto allowed = render;
    allowed.insert(allowed.end(), {"--allow-path", "."});
    EXPECT_EQ(run_aftershade(allowed, folder_.path()).err.find("leads out"), std::string::npos);
}

TEST_F(UntrustedFiles, BehindALinkDoNotGetIntoAReportsPage) {
    fs::create_directories(folder_ / "report/images");
    write_text(folder_ / "secret.txt", "c2VjcmV0");
    write_text(folder_ / "report/images/text.png", "not a picture, c2VjcmV0");
    fs::create_symlink("../../secret.txt", folder_ / "report/images/x.png");
    ASSERT_EQ(mkfifo((folder_ / "report/images/pipe.png").c_str(), 0600), 0);
    fs::create_symlink(fs::absolute(frame_path(1)), folder_ / "report/images/x.exr");
    ASSERT_EQ(mkfifo((folder_ / "report/images/pipe.exr").c_str(), 0600), 0);
    nlohmann::ordered_json images = nlohmann::ordered_json::array();
    for (const std::string name :
         {"x.png", "text.png", "pipe.png", "x.exr", "pipe.exr", "../../in_0001.exr"}) {
        const bool is_exr = name.ends_with(".exr");
        nlohmann::ordered_json pictures;
        for (const char* key :
             {"reference", "test", "difference", "heat_map", "side_by_side", "reference_exr", "test_exr"})
            pictures[key] = nullptr;
        pictures[is_exr ? "reference_exr" : "test"] = "images/" + name;
        images.push_back({{"name", name},
                          {"verdict", is_exr ? "failure" : "same"},
                          {"bits_equal", !is_exr},
                          {"pictures", pictures}});
    }
    const nlohmann::ordered_json report = {{"document", ""},
                                           {"environment", nlohmann::ordered_json::object()},
                                           {"counts", nlohmann::ordered_json::object()},
                                           {"orphans", nlohmann::ordered_json::array()},
                                           {"cases", {{{"name", "c"}, {"rerun", ""}, {"images", images}}}}};
    write_text(folder_ / "report/report.json", report.dump());
    const CommandResult result = run_aftershade({"golden", "report", "report"}, folder_.path());
    ASSERT_EQ(result.exit_code, 0) << result.err;
    const std::string page = read_text(folder_ / "report/index.html");
    for (const char* line :
         {"images/x.png: is a symbolic link, which is not followed here", "images/text.png: is not a PNG",
          "images/pipe.png: is not a regular file",
          "images/x.exr: is a symbolic link, which is not followed here",
          "images/pipe.exr: is not a regular file", "images/../../in_0001.exr: leads out of its folder"})
        EXPECT_NE(page.find(line), std::string::npos) << line;
    EXPECT_EQ(page.find("<script type=\"text/plain\""), std::string::npos) << "no pixel is in the page";
    for (const char* secret : {"c2VjcmV0", "YzJWamNtVjA"})
        EXPECT_EQ(page.find(secret), std::string::npos) << "plain, and as base64";
}

TEST_F(UntrustedFiles, AreAnyThatTheUsersOwnDocumentsName) {
    fs::create_directory(folder_ / "shot");
    write_text(folder_ / "shot/capture.json",
               R"({ "aftershade": 1, "profile": "native", "frames": ")" + frame_path(1).string() + "\" }");
    run({"nothing.json", "shot/capture.json", "-o", "out.exr"}, 0);
}

}  // namespace
}  // namespace aftershade::test
