// A small suite in a temporary folder: two frames of a capture, two cases.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "framework/file/exr_file.h"
#include "tests/cli/command.h"
#include "tests/synthetic_capture.h"

namespace aftershade::test {

class GoldenCommand : public testing::Test {
protected:
    using Json = nlohmann::ordered_json;

    GoldenCommand() {
        for (int frame = 1; frame <= 2; ++frame) write_frame(frame, 30);
        write_text(folder_ / "lens.json", kLens);
        write_suite(R"("fail": 0.004, "fail_percent": 0.1, "hard_fail": 0.25)");
    }

    /// The scene of the suite; the light of one point tells pictures apart.
    void write_frame(int frame, float point) {
        SyntheticScene scene{
            .width = 64, .height = 36, .background = {0.18f, 0.5f, 0.02f}, .background_depth_m = 6};
        scene.sphere = SyntheticSphere{20, 15, 9, 2};
        scene.points = {{50, 8, point}};
        write_capture(make_capture(scene, frame), folder_ / ("in_000" + std::to_string(frame) + ".exr"));
    }
    void write_suite(const std::string& tolerance, const std::string& more = "") {
        write_text(folder_ / "golden.json", R"({ "aftershade": 1, "cases": [
    { "name": "lens", "look": "lens.json", "capture": "in_####.exr", "frames": "1-2", "tags": ["slow"],
      "tolerance": {)" + tolerance + R"(} },
    { "name": "corner", "steps": [ { "effect": "vignette" } ], "capture": "in_0001.exr",
      "tolerance": {)" + tolerance + "} }" + more +
                                                " ] }");
    }

    CommandResult golden(std::vector<std::string> words, Environment environment = {}) {
        words.insert(words.begin(), "golden");
        environment.try_emplace("AFTERSHADE_BACKEND", "software");
        return run_aftershade(words, folder_.path(), environment);
    }
    CommandResult run(std::vector<std::string> words = {}, const Environment& environment = {}) {
        words.insert(words.begin(), {"run", "golden.json"});
        return golden(words, environment);
    }
    void approve(std::vector<std::string> words = {}) {
        words.insert(words.begin(), {"approve", "golden.json"});
        const CommandResult result = golden(words);
        ASSERT_EQ(result.exit_code, 0) << result.err;
    }
    Json report(std::vector<std::string> words = {}, const Environment& environment = {}) {
        words.push_back("--json");
        return Json::parse(run(words, environment).out);
    }
    std::filesystem::path image(const std::string& name) const {
        return folder_ / ("goldens/" + name + ".exr");
    }

    static const Json& case_of(const Json& report, std::string_view name) {
        for (const Json& test : report["cases"])
            if (test["name"] == name) return test;
        throw std::runtime_error("no case " + std::string(name));
    }
    static const Json& colors_of(const Json& image) {
        for (const Json& layer : image["comparison"]["layers"])
            if (layer["layer"] == "RGB") return layer;
        throw std::runtime_error("no layer RGB");
    }
    static bool all_bits_equal(const Json& report) {
        bool equal = !report["cases"].empty();
        for (const Json& test : report["cases"])
            for (const Json& image : test["images"]) equal &= image["bits_equal"].get<bool>();
        return equal;
    }

    /// The picture with something done to it, as a producer's file would hold it.
    template <typename Change>
    static void change_image(const std::filesystem::path& path, Change change) {
        const std::vector<std::string> names{"R", "G", "B", "A"};
        Image pixels = ExrFile(path).read_floats(0, names);
        change(pixels);
        std::vector<ExrOutputChannel> channels;
        for (int c = 0; c < 4; ++c) channels.push_back({names[std::size_t(c)], PixelType::half, &pixels, c});
        ExrWriteOptions options;
        options.data_window = options.display_window = {0, 0, pixels.width() - 1, pixels.height() - 1};
        write_exr(path, channels, options);
    }

    static constexpr const char* kLens = R"({ "aftershade": 1, "steps": [ { "effect": "bokeh",
        "params": { "f_number": 0.5, "focus_distance": "2 m", "shape": "hexagon", "rotation": 0 } } ] })";
    TemporaryFolder folder_;
};

}  // namespace aftershade::test
