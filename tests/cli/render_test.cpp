// Scenes through the command: captures that run can take, truths, conventions, faults.
#include <algorithm>
#include <fstream>
#include <set>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "framework/file/exr_file.h"
#include "tests/cli/command.h"
#include "tests/temporary_folder.h"

namespace aftershade::test {
namespace {

namespace fs = std::filesystem;
using Args = std::vector<std::string>;

std::string scene(const std::string& id) {
    return std::string(AFTERSHADE_SOURCE_DIR "/scenes/") + id;
}

class Render : public testing::Test {
protected:
    CommandResult render(Args arguments) {
        arguments.insert(arguments.begin(), {AFTERSHADE_EXECUTABLE, "render"});
        return Command(std::move(arguments), folder_.path()).wait();
    }
    CommandResult aftershade(Args arguments) {
        arguments.insert(arguments.begin(), AFTERSHADE_EXECUTABLE);
        return Command(std::move(arguments), folder_.path()).wait();
    }
    std::string bytes(const std::string& file) { return read_text(folder_ / file); }
    std::vector<float> channel(const std::string& file, const std::string& name) {
        const std::vector<std::string> one = {name};
        const Image image = ExrFile(folder_ / file).read_floats(0, one);
        return {image.floats().begin(), image.floats().end()};
    }
    TemporaryFolder folder_;
};

TEST_F(Render, MakesACaptureThatALookRunsOn) {
    const CommandResult made =
        render({scene("head"), "-o", "head", "--size", "96x54", "--frames", "1-3", "--truth", "scattering",
                "--truth", "lens+antialias", "--samples", "64"});
    ASSERT_EQ(made.exit_code, 0) << made.err;
    std::set<std::string> files;
    for (const std::string& line : lines_of_text(made.out)) files.insert(fs::path(line).filename().string());
    EXPECT_EQ(files, (std::set<std::string>{"capture.json", "gbuffer_0001.exr", "gbuffer_0002.exr",
                                            "gbuffer_0003.exr", "truth_lens_antialias_0001.exr",
                                            "truth_lens_antialias_0002.exr", "truth_lens_antialias_0003.exr",
                                            "truth_scattering_0001.exr", "truth_scattering_0002.exr",
                                            "truth_scattering_0003.exr"}));
    for (const std::string& line : lines_of_text(made.out)) EXPECT_TRUE(fs::exists(folder_ / line)) << line;
    const CommandResult ran = aftershade(
        {"run", AFTERSHADE_SOURCE_DIR "/scenes/looks/portrait.json", "head", "-o", "out_####.png"});
    EXPECT_EQ(ran.exit_code, 0) << ran.err;
    EXPECT_TRUE(fs::exists(folder_ / "out_0002.png"));
    const CommandResult told = aftershade({"inspect", "head"});
    EXPECT_EQ(told.exit_code, 0) << told.err;
    for (const char* role : {"irradiance", "velocity_next", "object_id", "emission"})
        EXPECT_NE(told.out.find(role), std::string::npos) << told.out;
}

TEST_F(Render, GivesTheSameBitsTwice) {
    for (const char* name : {"a", "b"})
        ASSERT_EQ(
            render({scene("wheel"), "-o", name, "--size", "64x36", "--frames", "1-24", "--jitter", "halton"})
                .exit_code,
            0);
    for (int frame = 1; frame <= 24; ++frame) {
        const std::string file =
            "/gbuffer_00" + std::string(frame < 10 ? "0" : "") + std::to_string(frame) + ".exr";
        ASSERT_EQ(bytes("a" + file), bytes("b" + file)) << file;
    }
    EXPECT_NE(bytes("a/gbuffer_0001.exr"), bytes("a/gbuffer_0002.exr"));
}

TEST_F(Render, ReportsTheShadingRateOfManyVisibilitySamples) {
    const CommandResult made =
        render({scene("toys"), "-o", "toys", "--size", "96x54", "--frames", "4", "--truth-only",
                "--visibility", "memoised", "--visibility-samples", "8", "--shading-cache", "tile",
                "--shading-tile", "8", "--anisotropic-shading", "--json", "--quiet"});
    ASSERT_EQ(made.exit_code, 0) << made.err;
    const auto report = nlohmann::json::parse(made.out);
    const auto frame = report.at("visibility").at(0);
    const double misses = frame.at("misses"), hits = frame.at("hits");
    EXPECT_EQ(hits + misses, 96 * 54 * 8);
    EXPECT_NEAR(frame.at("shading_rate").at("mean"), misses / (96 * 54), 1e-9);
    EXPECT_LT(misses, hits);
    EXPECT_EQ(frame.at("bytes").at("supersampled"), 96 * 54 * 8 * 12);
    double sum = 0;
    for (const float rate : channel("toys/memoised_rate_0004.exr", "rate")) sum += double(rate);
    EXPECT_NEAR(sum, misses, 0.5);
    EXPECT_EQ(channel("toys/memoised_0004.exr", "R").size(), 96u * 54);
    EXPECT_TRUE(fs::exists(folder_ / "toys/memoised_rate_0004.png"));
}

TEST_F(Render, ReportsTheShadingSamplesThatItKeepsFromFrameToFrame) {
    const CommandResult made = render({scene("camera_checker"), "-o", "hall", "--size", "96x54", "--frames",
                                       "1-2", "--truth-only", "--visibility", "memoised",
                                       "--visibility-samples", "8", "--keep-shading", "--json", "--quiet"});
    ASSERT_EQ(made.exit_code, 0) << made.err;
    const auto frames = nlohmann::json::parse(made.out).at("visibility");
    EXPECT_EQ(frames.at(0).at("kept").at("samples"), 0);
    EXPECT_GT(frames.at(1).at("kept").at("samples"), 1000);
    EXPECT_GT(frames.at(1).at("kept").at("highlights"), 0);
    EXPECT_GT(frames.at(1).at("bytes").at("kept"), 0);
}

/// `toys` by memoised visibility at 64 samples, on `gl` or `cpu`, with so many threads of llvmpipe.
nlohmann::json visibility_on(const std::string& processor, const fs::path& folder, const std::string& threads,
                             const Args& more) {
    Args words = {AFTERSHADE_EXECUTABLE,
                  "render",
                  scene("toys"),
                  "-o",
                  processor + threads,
                  "--frames",
                  "4",
                  "--truth-only",
                  "--visibility",
                  "memoised",
                  "--visibility-samples",
                  "64",
                  "--visibility-on",
                  processor,
                  "--json",
                  "--quiet"};
    if (processor == "gl") words.insert(words.end(), {"--backend", "software"});
    words.insert(words.end(), more.begin(), more.end());
    const CommandResult made = Command(std::move(words), folder, {{"LP_NUM_THREADS", threads}}).wait();
    EXPECT_EQ(made.exit_code, 0) << made.err;
    return nlohmann::json::parse(made.out);
}

TEST_F(Render, TracesVisibilityWithGlAlikeOnOneThreadAndOnTwo) {
    std::vector<std::vector<float>> reds;
    for (const char* threads : {"1", "2"}) {
        const auto report = visibility_on("gl", folder_.path(), threads, {"--size", "96x54"});
        const auto counted = report.at("gl").at("frames").at(0);
        EXPECT_EQ(counted.at("misses"), report.at("visibility").at(0).at("misses"));
        EXPECT_EQ(counted.at("hits"), report.at("visibility").at(0).at("hits"));
        EXPECT_EQ(counted.at("overflows"), 0);
        for (const char* pass : {"trace", "requests", "shade", "resolve"})
            EXPECT_GT(report.at("gl").at("passes_ms").at(std::string("visibility.") + pass), 0) << pass;
        reds.push_back(channel("gl" + std::string(threads) + "/memoised_0004.exr", "R"));
    }
    EXPECT_EQ(reds[0], reds[1]);
}

TEST_F(Render, PacksAsHardAsItsLevelOfZipSays) {
    const auto size_of = [&](const std::string& compression, const std::string& kind) {
        Args words = {scene("toys"), "-o", "out",           "--size",   "160x90",
                      "--frames",    "4",  "--compression", compression};
        if (!kind.empty()) words.push_back(kind);
        EXPECT_EQ(render(words).exit_code, 0);
        return fs::file_size(folder_ / "out/gbuffer_0004.exr");
    };
    EXPECT_LT(size_of("zip:9", ""), size_of("zip:1", ""));
    EXPECT_LT(size_of("zip:9", "--deep"), size_of("zip:1", "--deep"));
    const CommandResult refused = render({scene("toys"), "-o", "out", "--compression", "zip:0"});
    EXPECT_EQ(refused.exit_code, 2);
    EXPECT_NE(refused.err.find("zip:0 is not one of"), std::string::npos) << refused.err;
}

TEST_F(Render, EndsWithGlsLockedBucketsOnOneThreadAndOnTwo) {
    const Args small_cache = {"--size", "64x36", "--shading-cache", "fifo", "--cache-entries", "256"};
    const auto cpu = visibility_on("cpu", folder_.path(), "1", small_cache).at("visibility").at(0);
    for (const char* threads : {"1", "2"}) {
        const auto report = visibility_on("gl", folder_.path(), threads, small_cache);
        const auto counted = report.at("gl").at("frames").at(0), drawn = report.at("visibility").at(0);
        EXPECT_EQ(counted.at("hits").get<int>() + counted.at("misses").get<int>(),
                  cpu.at("hits").get<int>() + cpu.at("misses").get<int>());
        EXPECT_LT(counted.at("misses").get<double>(), 3 * cpu.at("misses").get<double>());
        // An address that goes while it is read is one shading more.
        EXPECT_GE(drawn.at("misses"), counted.at("misses"));
        EXPECT_EQ(drawn.at("hits").get<int>() + drawn.at("misses").get<int>(),
                  cpu.at("hits").get<int>() + cpu.at("misses").get<int>());
    }
}

TEST_F(Render, CountsTheTransparentSurfacesInItsLists) {
    const auto lists_of = [&](const std::string& nodes) {
        const CommandResult made =
            render({scene("panes"), "-o", "panes", "--size", "96x54", "--frames", "4", "--truth-only",
                    "--visibility", "memoised", "--visibility-samples", "8", "--transparency", "lists",
                    "--list-nodes", nodes, "--json", "--quiet"});
        EXPECT_EQ(made.exit_code, 0) << made.err;
        return nlohmann::json::parse(made.out).at("visibility").at(0).at("lists");
    };
    const auto all = lists_of("64"), some = lists_of("4");
    EXPECT_EQ(all.at("overflows"), 0);
    EXPECT_GT(all.at("nodes"), 96 * 54);
    EXPECT_GT(some.at("overflows"), 0);
    EXPECT_LE(some.at("nodes"), 4 * 96 * 54);
}

TEST_F(Render, RefusesWaysOfTransparencyAndCachesThatDoNotFit) {
    const std::vector<std::pair<Args, std::string>> faults = {
        {{"--visibility", "supersampled", "--transparency", "lists"},
         "--transparency lists: error: is for --visibility memoised"},
        {{"--visibility", "memoised", "--transparency", "sorted"},
         "--transparency sorted: error: is for --visibility supersampled or accumulation"},
        {{"--visibility", "memoised", "--visibility-on", "gl", "--transparency", "lists"},
         "--transparency lists: error: is for --visibility-on cpu; gl takes stochastic"},
        {{"--visibility", "supersampled", "--visibility-on", "gl", "--transparency", "sorted"},
         "--transparency sorted: error: is for --visibility-on cpu; gl takes stochastic"},
        {{"--visibility-on", "gl"},
         "--visibility-on gl: error: is for --visibility memoised, supersampled or accumulation"},
        {{"--visibility", "memoised", "--visibility-on", "gl", "--shading-cache", "lru"},
         "--shading-cache lru: error: is for --visibility-on cpu; gl has fifo, in buckets of four entries"},
        {{"--visibility", "memoised", "--keep-shading", "--visibility-on", "gl"},
         "--keep-shading: error: is for --visibility-on cpu"},
        {{"--visibility", "memoised", "--keep-shading", "--shading-cache", "tile"},
         "--keep-shading: error: is for --shading-cache global"},
        {{"--visibility", "memoised", "--list-nodes", "9"},
         "--list-nodes: error: is for --transparency lists"},
        {{"--truth", "scattering"},
         "--truth scattering: error: the scene has materials with an \"opacity\""}};
    for (const auto& [words, message] : faults) {
        Args all = {scene("panes"), "-o", "panes"};
        all.insert(all.end(), words.begin(), words.end());
        const CommandResult refused = render(all);
        EXPECT_EQ(refused.exit_code, 2);
        EXPECT_NE(refused.err.find(message), std::string::npos) << refused.err;
    }
}

TEST_F(Render, RefusesACacheWithoutShadingSamples) {
    const CommandResult refused =
        render({scene("toys"), "-o", "toys", "--visibility", "supersampled", "--shading-cache", "lru",
                "--anisotropic-shading", "--keep-shading"});
    EXPECT_EQ(refused.exit_code, 2);
    for (const char* option : {"--shading-cache", "--anisotropic-shading", "--keep-shading"})
        EXPECT_NE(refused.err.find(std::string(option) + ": error: is for --visibility memoised"),
                  std::string::npos)
            << refused.err;
}

TEST_F(Render, WritesSubframesThatAreOneFramesExposure) {
    ASSERT_EQ(render({scene("moving_box"), "-o", "box", "--size", "120x68", "--frames", "4-5", "--subframes",
                      "4", "--truth", "shutter", "--samples", "4"})
                  .exit_code,
              0);
    std::vector<double> mean;
    for (int s = 0; s < 4; ++s) {
        const std::vector<float> part = channel("box/gbuffer_00" + std::to_string(16 + s) + ".exr", "R");
        mean.resize(part.size());
        for (std::size_t i = 0; i < part.size(); ++i) mean[i] += part[i] / 4.0;
    }
    const std::vector<float> truth = channel("box/truth_shutter_0004.exr", "R");
    for (std::size_t i = 0; i < truth.size(); ++i) ASSERT_NEAR(truth[i], mean[i], 1e-6);
    // Frame 4 of a capture with 4 sub-frames is the files 16 to 19, as capture.json says.
    const CommandResult told = aftershade({"inspect", "box/capture.json", "--frames", "4"});
    EXPECT_EQ(told.exit_code, 0) << told.err;
}

/// Each decoder against a renderer that knows the truth: the velocities of its own pictures must explain
/// them.
TEST_F(Render, SpeaksTheConventionsOfOtherProducers) {
    for (const std::string profile : {"native", "blender", "unreal", "nuke"}) {
        ASSERT_EQ(render({scene("wheel"), "-o", profile, "--size", "320x180", "--frames", "5-6", "--profile",
                          profile})
                      .exit_code,
                  0);
        const CommandResult checked = aftershade(
            {"inspect", "--check-velocity", profile + "/gbuffer_0005.exr", profile + "/gbuffer_0006.exr"});
        EXPECT_EQ(checked.exit_code, 0) << profile << checked.out << checked.err;
        EXPECT_NE(checked.out.find("The profile is right"), std::string::npos) << checked.out;
    }
    const CommandResult left_out =
        render({scene("plane_edge"), "-o", "u", "--size", "32x18", "--profile", "unreal"});
    EXPECT_NE(left_out.err.find("'unreal' has no way to store"), std::string::npos) << left_out.err;
    EXPECT_NE(left_out.err.find("irradiance"), std::string::npos) << left_out.err;
}

TEST_F(Render, WritesTextureSpace) {
    const CommandResult made = render({scene("head"), "-o", "uv", "--space", "uv", "--object", "skull",
                                       "--texture-size", "64", "--frames", "2"});
    ASSERT_EQ(made.exit_code, 0) << made.err;
    const ExrFile file(folder_ / "uv/gbuffer_0002.exr");
    EXPECT_EQ(file.parts()[0].data_window.width(), 64);
    std::set<std::string> names;
    for (const ExrChannel& one : file.parts()[0].channels) names.insert(one.name);
    EXPECT_TRUE(names.contains("irradiance.R") && names.contains("position.X"));
    EXPECT_FALSE(names.contains("Z") || names.contains("velocity.X"));
}

TEST_F(Render, TellsWhatIsInTheHeader) {
    ASSERT_EQ(render({scene("head"), "-o", "head", "--size", "32x18", "--frames", "3", "--jitter", "halton"})
                  .exit_code,
              0);
    const ExrFile file(folder_ / "head/gbuffer_0003.exr");
    const ExrMetadata& metadata = file.parts()[0].metadata;
    EXPECT_NEAR(metadata.number("aftershade/camera/focal_length").value_or(0), 62, 1e-4);
    EXPECT_NEAR(metadata.number("framesPerSecond").value_or(0), 24, 1e-9);
    ASSERT_TRUE(metadata.value("worldToNDC") && metadata.value("worldToCamera"));
    // Phase 4 of the sequence: radical inverses of 4 in bases 2 and 3, minus a half.
    const auto jitter = std::get<std::vector<float>>(metadata.value("aftershade/jitter_px").value());
    EXPECT_FLOAT_EQ(jitter[0], 0.125f - 0.5f);
    EXPECT_FLOAT_EQ(jitter[1], float(4.0 / 9 - 0.5));
    const auto lights = nlohmann::json::parse(metadata.text("aftershade/lights").value_or("[]"));
    ASSERT_EQ(lights.size(), 2u);
    EXPECT_EQ(lights[0]["name"], "key");
    // The light moves, so that capture.json, which would overrule the headers, has none.
    const auto document = nlohmann::json::parse(bytes("head/capture.json"));
    EXPECT_FALSE(document.contains("lights"));
    EXPECT_EQ(document["camera"]["lens_model"], "pinhole");
    const CommandResult told = aftershade({"inspect", "head"});
    EXPECT_NE(told.out.find("jitter"), std::string::npos) << told.out;
    EXPECT_NE(told.out.find("key             point"), std::string::npos) << told.out;
}

struct Fault {
    Args arguments;
    const char* message;
};

TEST_F(Render, TellsWhatIsWrongWithTheCommand) {
    const std::string head = scene("head");
    const Fault faults[] = {
        {{head, "-o", "x", "--truth", "lense"}, "--truth lense: error: is neither scattering nor lens"},
        {{head, "-o", "x", "--truth", "lens+lens"}, "is neither scattering nor lens"},
        {{head, "-o", "x", "--size", "96"}, "a size is WIDTHxHEIGHT"},
        {{head, "-o", "x", "--frames", "a"}, "not a frame range such as"},
        {{head, "-o", "x", "--space", "uv"}, "--space uv needs the name of an object: 'skull'"},
        {{head, "-o", "x", "--space", "uv", "--object", "skul"}, "did you mean 'skull'?"},
        {{head, "-o", "x", "--object", "skull"}, "is for --space uv"},
        {{head, "-o", "x", "--profile", "blendr"}, "did you mean 'blender'?"},
        {{head, "-o", "x", "--truth-only"}, "leaves nothing to render; add --truth or --visibility"},
        {{scene("wheel"), "-o", "x", "--truth", "scattering"},
         "no material of the scene has a \"scattering_profile\""},
        {{"nowhere", "-o", "x"}, "nowhere"},
    };
    for (const Fault& fault : faults) {
        const CommandResult result = render(fault.arguments);
        EXPECT_EQ(result.exit_code, 2) << fault.message << result.err;
        EXPECT_NE(result.err.find(fault.message), std::string::npos) << result.err;
    }
    EXPECT_FALSE(fs::exists(folder_ / "x"));
}

TEST_F(Render, TellsWhereItCannotWrite) {
    std::ofstream(folder_ / "file") << "x";
    const CommandResult result = render({scene("plane_edge"), "-o", "file/inside", "--size", "16x9"});
    EXPECT_EQ(result.exit_code, 6) << result.err;
    EXPECT_NE(result.err.find("file/inside"), std::string::npos) << result.err;
}

}  // namespace
}  // namespace aftershade::test
