// Looks of ISF files, run by the command.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "framework/file/exr_file.h"
#include "tests/cli/command.h"
#include "tests/effect/broken_isf.h"
#include "tests/synthetic_capture.h"

namespace aftershade::test {

namespace fs = std::filesystem;

inline constexpr int kWidth = 16, kHeight = 8;
inline const std::string kImage = R"("INPUTS": [{"NAME": "inputImage", "TYPE": "image"}])";
inline const std::string kRamp =
    "void main() { gl_FragColor = vec4(isf_FragNormCoord, gl_FragCoord.y / RENDERSIZE.y, 1.0); }\n";

class IsfFiles : public testing::Test {
protected:
    IsfFiles() {
        for (int frame = 1; frame <= 4; ++frame) {
            Capture capture =
                make_capture({.width = kWidth, .height = kHeight, .background = {0.25f, 0.5f, 1.0f}}, frame);
            for (int y = 0; y < kHeight; ++y)
                for (int x = 0; x < kWidth; ++x) capture.images.at("color").at(x, y, 3) = 0.5f;
            write_capture(capture, folder_ / ("in_000" + std::to_string(frame) + ".exr"));
        }
        fs::create_directories(folder_ / "filters");
    }

    void write_filter(const std::string& name, const std::string& members, const std::string& shader) {
        write_text(folder_ / "filters" / name,
                   isf_file(members.empty() ? "\"CREDIT\": \"me\"" : members, shader));
    }
    CommandResult run(const std::string& steps, std::vector<std::string> words, int exit_code = 0) {
        write_text(folder_ / "look.json", R"({"aftershade": 1, "steps": [)" + steps + "]}");
        std::vector<std::string> all{"run", "look.json"};
        all.insert(all.end(), words.begin(), words.end());
        all.insert(all.end(), {"--backend", "software", "--progress", "none"});
        CommandResult result = run_aftershade(all, folder_.path());
        EXPECT_EQ(result.exit_code, exit_code) << result.out << result.err;
        return result;
    }
    /// What one frame looks like after these steps.
    Image display(const std::string& steps) {
        run(steps, {"in_0001.exr", "-o", "out.exr", "--output-roles", "display", "--pixel-type", "float"});
        return read(folder_ / "out.exr", "display.");
    }
    static Image read(const fs::path& path, const std::string& prefix) {
        std::vector<std::string> channels;
        for (const std::string& channel : kRgba) channels.push_back(prefix + channel);
        return ExrFile(path).read_floats(0, channels);
    }
    static std::string step(const std::string& name, const std::string& more = "") {
        return R"({"effect": "filters/)" + name + "\"" + more + "}";
    }

    TemporaryFolder folder_;
};

}  // namespace aftershade::test
