// Tolerances of cases that leave pixels out, hold some to other limits, or forgive.
#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "framework/file/exr_file.h"
#include "framework/file/png_file.h"
#include "tests/cli/golden_suite.h"
#include "tests/compare/pictures.h"

namespace aftershade::test {
namespace {

class GoldenTolerances : public GoldenCommand {};

TEST_F(GoldenTolerances, LeaveOutPixelsAndNameThem) {
    const std::string fail = R"("fail": 0.004, )";
    approve();
    change_image(image("corner.color.0001"), [](Image& pixels) {
        for (int y = 4; y < 9; ++y)
            for (int x = 50; x < 60; ++x) pixels.at(x, y, 1) += 0.5f;
    });
    std::filesystem::remove(image("corner.color.0001").replace_extension(".json"));  // of the image as it was
    const auto verdict = [&](const std::string& more) {
        write_suite(fail + more);
        return case_of(report({"--filter", "corner"}), "corner");
    };
    EXPECT_EQ(verdict(R"("fail_percent": 0)")["verdict"], "failure");
    const Json left_out = verdict(R"("ignore": [ { "rectangle": [50, 4, 10, 5] } ])");
    EXPECT_EQ(left_out["verdict"], "same");
    EXPECT_EQ(colors_of(left_out["images"][0])["left_out_pixels"], 50);
    EXPECT_EQ(left_out["images"][0]["comparison"]["rules"]["ignore"], Json::array({"50,4,10,5"}));
    EXPECT_NE(run({"--filter", "corner"}).err.find("% of the pixels left out)"), std::string::npos);
    EXPECT_EQ(verdict(R"("areas": [ { "rectangle": [50, 4, 10, 5], "fail": 0.6 } ])")["verdict"], "same");
    EXPECT_EQ(verdict(R"("areas": [ { "rectangle": [50, 4, 10, 5], "fail": 0.4 } ])")["verdict"], "failure");
    EXPECT_EQ(verdict(R"("layers": { "RGB": { "fail": 0.6 } })")["verdict"], "same");
    EXPECT_EQ(verdict(R"("forgive_blur": 32, "layers": { "RGB": { "fail": 0.05 } })")["verdict"], "same");
    write_png(folder_ / "mask.png", constant(64, 36, {1}));
    EXPECT_EQ(verdict(R"("ignore": [ { "mask": "mask.png" } ])")["verdict"], "different size or channels")
        << "nothing is left to compare";
    EXPECT_EQ(verdict(R"("ignore": [ { "mask": "none.png" } ])")["verdict"], "file error");
    const Json unknown = verdict(R"("layers": { "RGBX": { "fail": 0.6 } })");
    EXPECT_EQ(unknown["verdict"], "failure") << "a layer that no image has";
    EXPECT_NE(unknown["messages"].dump().find("did you mean 'RGB'"), std::string::npos)
        << unknown["messages"];
}

/// The synthetic scene's sphere has an id of its own.
TEST_F(GoldenTolerances, LeaveOutTheObjectsOfTheCapture) {
    approve();
    const Image ids = ExrFile(folder_ / "in_0001.exr").read_uints(0, std::vector<std::string>{"object_id.I"});
    const std::uint32_t sphere = ids.uint_at(20, 15, 0);
    ASSERT_NE(sphere, ids.uint_at(2, 2, 0));
    change_image(image("corner.color.0001"), [&](Image& pixels) {
        for (int y = 0; y < pixels.height(); ++y)
            for (int x = 0; x < pixels.width(); ++x)
                if (ids.uint_at(x, y, 0) == sphere) pixels.at(x, y, 0) += 0.5f;
    });
    std::filesystem::remove(image("corner.color.0001").replace_extension(".json"));  // of the image as it was
    EXPECT_EQ(run({"--filter", "corner"}).exit_code, 2);
    write_suite(R"("fail": 0.004, "ignore": [ { "object": )" + std::to_string(sphere) + " } ]");
    EXPECT_EQ(run({"--filter", "corner"}).exit_code, 0) << run({"--filter", "corner"}).err;
}

}  // namespace
}  // namespace aftershade::test
