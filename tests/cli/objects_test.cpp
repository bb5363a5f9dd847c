// Objects that a look names and no frame has: `run` says so at its end.
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <nlohmann/json.hpp>

#include "framework/capture/cryptomatte.h"
#include "tests/cli/batch_work.h"

namespace aftershade::test {
namespace {

class Objects : public BatchWork {
protected:
    /// Object 2 is in frames 1 and 2 and has left the picture in 3 and 4.
    void write_shot() {
        SyntheticScene scene{
            .width = 32, .height = 18, .background = {0.1f, 0.2f, 0.4f}, .background_depth_m = 8};
        scene.box = SyntheticBox{-4, 6, 8, 6, 14, 0};
        for (int frame = 1; frame <= 4; ++frame) write_capture(make_capture(scene, frame), frame_path(frame));
    }
    /// One frame whose Cryptomatte has the object Cube and no manifest.
    void write_matte() {
        Image image(4, 1, 4);
        for (int x = 0; x < 4; ++x) image.at(x, 0, 2) = 0.5f;
        image.at(1, 0, 0) = std::bit_cast<float>(cryptomatte_hash("Cube"));
        image.at(1, 0, 1) = 1;
        std::vector<ExrOutputChannel> channels;
        for (const char* name : {"R", "G", "B"}) channels.push_back({name, PixelType::half, &image, 2});
        for (int c = 0; c < 4; ++c)
            channels.push_back(
                {std::string("crypto00.") + "RGBA"[c], PixelType::float32, &image, c < 2 ? c : 3});
        ExrWriteOptions options;
        options.data_window = options.display_window = {0, 0, 3, 0};
        options.attributes["cryptomatte/3ae39a5/name"] = "crypto";
        write_exr(frame_path(1), channels, options);
    }
    void write_look(const std::string& step) {
        write_text(folder_ / "look.json", R"({ "aftershade": 1, "steps": [)" + step + "] }");
    }
    std::string errors(std::vector<std::string> more = {}) {
        std::vector<std::string> arguments{"look.json", "in_####.exr", "-o", "out_####.exr", "--overwrite"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        return run(arguments, 0).err;
    }
    static std::ptrdiff_t warnings(const std::string& err) {
        const auto lines = lines_of_text(err);
        return std::ranges::count_if(
            lines, [](const std::string& line) { return line.find("no pixel in any") != std::string::npos; });
    }
};

const char* const kRows = R"({ "effect": "motion_blur", "params": { "objects": { "rows":
    [ { "object": 2, "scale": 0 }, { "object": 7, "scale": 0 }, { "objects": "90-99", "scale": 2 } ] } } })";

TEST_F(Objects, OfRowsThatNoFrameHasAreWarnedOf) {
    write_shot();
    write_look(kRows);
    const std::string expected =
        "motion_blur.objects: object 7 and objects 90-99 have no pixel in any frame of this run (`aftershade "
        "inspect CAPTURE --pixel X,Y` prints the id at a pixel; object_id has 0 and 2)\n";
    const std::string err = errors();
    EXPECT_NE(err.find("aftershade: warning: look.json:1:"), std::string::npos) << err;
    EXPECT_NE(err.find(expected), std::string::npos) << err;
    EXPECT_EQ(warnings(errors({"--progress", "none"})), 1) << "a warning, whatever the style of progress";
    const std::string later = errors({"--frames", "3-4"});
    EXPECT_NE(later.find("object 2, object 7 and objects 90-99 have no pixel"), std::string::npos) << later;
}

TEST_F(Objects, AreLookedForInTheFramesOfAllWorkers) {
    write_shot();
    write_look(kRows);
    const std::string err = errors({"--jobs", "2"});
    EXPECT_EQ(warnings(err), 1) << "the worker of frames 3 and 4 has no object 2\n" << err;
    EXPECT_NE(err.find("object 7 and objects 90-99 have no pixel"), std::string::npos) << err;
    EXPECT_EQ(err.find("object 2"), std::string::npos) << err;
    const std::string lines = errors({"--jobs", "2", "--progress", "json"});
    for (const std::string& line : lines_of_text(lines)) {
        if (line.find("no pixel") == std::string::npos) continue;
        EXPECT_EQ(nlohmann::json::parse(line)["event"], "warning") << line;
    }
    EXPECT_EQ(warnings(lines), 1) << lines;
}

TEST_F(Objects, OfAMaskThatNoFrameHasAreWarnedOf) {
    write_shot();
    write_look(R"({ "effect": "sharpen", "mask": { "object": [2, 5] } })");
    const std::string err = errors();
    EXPECT_NE(err.find("the mask of step 'sharpen': object 5 has no pixel in any frame"), std::string::npos)
        << err;
    write_look(R"({ "effect": "sharpen", "mask": { "object": "0-2" } })");
    EXPECT_EQ(warnings(errors()), 0);
}

TEST_F(Objects, ByNamesThatACryptomatteWithoutManifestLacksAreWarnedOf) {
    write_matte();
    write_look(R"({ "effect": "sharpen", "mask": { "object": "Cuve" } })");
    const std::string err = errors();
    EXPECT_NE(err.find("the mask of step 'sharpen': 'Cuve' has no pixel in any frame of this run "
                       "(`aftershade inspect CAPTURE --cryptomatte` lists the names and, without a manifest, "
                       "their hashes)"),
              std::string::npos)
        << err;
    write_look(R"({ "effect": "sharpen", "mask": { "object": "Cube" } })");
    EXPECT_EQ(warnings(errors()), 0);
}

/// Skin in a frame of the focal length 50 mm on 36 mm, 32 px wide: light goes d * 32 * 50 / 36 px over the
/// distance in mm, of red light in `skin` 0.4445 mm.
class Scattering : public Objects {
protected:
    void write_frame(float background_m, int box_id) {
        SyntheticScene scene{
            .width = 32, .height = 18, .background = {0.1f, 0.2f, 0.4f}, .background_depth_m = background_m};
        scene.box = SyntheticBox{.x = 2, .y = 6, .width = 8, .height = 6, .depth_m = background_m / 2};
        Capture capture = make_capture(scene, 1);
        capture.images.erase("mask");
        for (std::uint32_t& id : capture.images.at("object_id").uints())
            id = id == 2 ? std::uint32_t(box_id) : 5;
        write_capture(capture, frame_path(1));
    }
    std::string errors_of(const std::string& params, const std::string& more = "") {
        write_look(R"({ "effect": "sss_burley", "params": {)" + params + "}" + more + "}");
        return errors();
    }
};

TEST_F(Scattering, OfEveryObjectIsWarnedOfWhereFramesHaveSeveral) {
    const std::string expected =
        "aftershade: warning: sss_burley.object_ids is empty, so the step works on every object, and frames "
        "have "
        "several (name those that are meant, or give the step a mask)\n";
    write_frame(0.2f, 2);
    const std::string err = errors_of("");
    EXPECT_NE(err.find(expected), std::string::npos) << err;
    for (const std::string& sound :
         {errors_of(R"("object_ids": [2])"), errors_of("", R"(, "mask": { "object": [2] })")})
        EXPECT_EQ(sound.find("is empty"), std::string::npos) << sound;
    write_frame(0.2f, 5);
    const std::string one = errors_of("");
    EXPECT_EQ(one.find("is empty"), std::string::npos) << one;
}

TEST_F(Scattering, ThatIsTooNarrowToBeSeenIsWarnedOfWithItsWidth) {
    // The box at 4 m: 0.4445 / 4000 * 32 * 50 / 36 = 0.00494 px.
    write_frame(8, 2);
    const std::string expected =
        "sss_burley.scattering_profile: light goes at most 0.0049 px far, by the profile's d, at the nearest "
        "pixel, "
        "and below 0.1 px nothing of it is seen (the scene's unit may be another than the metre: world_unit, "
        "now "
        "1000, is the millimetres of the profile for each metre of the capture)\n";
    const std::string err = errors_of(R"("object_ids": [2], "scattering_profile": "skin")");
    EXPECT_NE(err.find(expected), std::string::npos) << err;
    EXPECT_NE(err.find("look.json:1:"), std::string::npos) << err;
    // Of the background, twice as far away, half of it.
    const std::string far = errors_of(R"("object_ids": [5])");
    EXPECT_NE(far.find("at most 0.0025 px"), std::string::npos) << far;
    // 21 times wider it is wide enough, 20 times it is not.
    EXPECT_EQ(errors_of(R"("object_ids": [2], "world_unit": 47.6)").find("nothing of it"), std::string::npos);
    EXPECT_NE(errors_of(R"("object_ids": [2], "world_unit": 50)").find("nothing of it"), std::string::npos);
    write_look(R"({ "effect": "sss_burley", "params": { "object_ids": [2] } })");
    const std::string jobs = errors({"--jobs", "1"});
    EXPECT_NE(jobs.find("at most 0.0049 px"), std::string::npos) << jobs;
}

}  // namespace
}  // namespace aftershade::test
