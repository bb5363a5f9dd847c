// A sequence and looks for tests of batches: a look with history, one that blurs, one that makes NaN.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <limits>
#include <string>
#include <vector>

#include "framework/base/error.h"
#include "framework/capture/frame_range.h"
#include "framework/file/exr_file.h"
#include "tests/cli/command.h"
#include "tests/not_finite.h"
#include "tests/synthetic_capture.h"

namespace aftershade::test {

class BatchWork : public testing::Test {
protected:
    BatchWork() {
        write_text(folder_ / "nothing.json", R"({ "aftershade": 1, "steps": [] })");
        // Each frame holds half of those before it.
        write_effect(
            "trail",
            R"("textures": { "kept": { "format": "rgba32f", "history": true, "doc": "Light so far." } },
                        "passes": [ { "name": "main", "shader": "main.frag", "reads": ["color", "kept.prev"],
                                      "writes": ["kept"] },
                                    { "name": "show", "shader": "show.frag", "reads": ["kept"],
                                      "writes": ["color"] } ])",
            "vec4 now = texelFetch(color, p, 0);\n"
            "out_kept = frame.history_valid ? mix(now, texelFetch(kept_prev, p, 0), 0.5) : now;");
        write_text(folder_ / "effects/trail/show.frag", head() + "out_color = texelFetch(kept, p, 0);\n}\n");
        const std::string one_pass =
            R"("passes": [ { "name": "main", "shader": "main.frag", "reads": ["color"], "writes": ["color"] } ])";
        write_effect("spread", one_pass,
                     "vec4 sum = vec4(0.0);\n"
                     "for (int y = -2; y <= 2; ++y) for (int x = -2; x <= 2; ++x)\n"
                     "sum += texelFetch(color, clamp(p + ivec2(x, y), ivec2(0), frame.size - 1), 0);\n"
                     "out_color = sum / 25.0;");
        write_effect("poison", one_pass,
                     "out_color = texelFetch(color, p, 0);\n"
                     "if (p == ivec2(9, 4)) out_color.g = uintBitsToFloat(0x7fc00000u);");
    }

    /// in_0001.exr and so on, of a moving box.
    void write_frames(int first, int last, int width = 64, int height = 36) {
        SyntheticScene scene{
            .width = width, .height = height, .background = {0.1f, 0.2f, 0.4f}, .background_depth_m = 8};
        scene.box = SyntheticBox{4, 6, 16, 12, 5, 2};
        for (int frame = first; frame <= last; ++frame)
            write_capture(make_capture(scene, frame), frame_path(frame));
    }
    std::filesystem::path frame_path(int frame) const {
        return folder_ / FramePattern("in_####.exr").path(frame);
    }

    static std::vector<std::string> words(std::vector<std::string> arguments) {
        arguments.insert(arguments.begin(), "run");
        for (const char* word :
             {"--effect-path", "effects", "--backend", "software", "--pixel-type", "float"})
            arguments.push_back(word);
        return arguments;
    }
    CommandResult run(const std::vector<std::string>& arguments, int exit_code,
                      const Environment& environment = {}) const {
        CommandResult result = run_aftershade(words(arguments), folder_.path(), environment);
        EXPECT_EQ(result.exit_code, exit_code) << result.err;
        return result;
    }
    Image color(const std::string& name) const {
        return ExrFile(folder_ / name).read_floats(0, std::vector<std::string>{"R", "G", "B", "A"});
    }
    /// Names of the folder's files that a killed run would leave.
    std::vector<std::string> temporaries() const {
        std::vector<std::string> names;
        for (const auto& [name, bytes] : contents(folder_.path()))
            if (name.ends_with(".tmp")) names.push_back(name);
        return names;
    }

    static std::string head() {
        return "#version 450 core\n#include <pass>\nvoid main() {\nivec2 p = ivec2(gl_FragCoord.xy);\n";
    }
    /// effects/<id>, color in and out, whose main.frag has these statements, `p` being the pixel; and a look
    /// <id>.json of it alone.
    void write_effect(const std::string& id, const std::string& sections, const std::string& shader) const {
        const std::filesystem::path effect = folder_ / ("effects/" + id);
        std::filesystem::create_directories(effect);
        write_text(effect / "effect.json",
                   R"({ "aftershade": 1, "version": "1.0.0", "summary": "A test.", "id": ")" + id +
                       R"(", "inputs": { "color": { "role": "color" } },
                           "outputs": { "color": { "role": "color" } }, )" +
                       sections + "}");
        write_text(effect / "main.frag", head() + shader + "\n}\n");
        write_text(folder_ / (id + ".json"),
                   R"({ "aftershade": 1, "steps": [ { "effect": ")" + id + "\" } ] }");
    }

    TemporaryFolder folder_;
};

}  // namespace aftershade::test
