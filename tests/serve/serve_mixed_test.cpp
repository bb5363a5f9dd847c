// The page over a sequence whose frames differ from the first one.
#include <gtest/gtest.h>

#include "framework/image/color_space.h"
#include "tests/mixed_frames.h"
#include "tests/serve/serve_fixture.h"

namespace aftershade::test {
namespace {

class ServeMixed : public Serve {
protected:
    ServeMixed() { frames_ = 3; }
    void change_frames() const override {
        write_tenths(folder_ / "in_0001.exr", view_layers({"Zeta"}));
        write_tenths(folder_ / "in_0002.exr", view_layers({"Beta", "Zeta"}), attributes_);
        write_tenths(folder_ / "in_0003.exr", view_layers({third_}));
    }
    std::vector<float> color(int frame) const {
        const Answer answer = get("/api/probe?x=3&y=4&frame=" + std::to_string(frame));
        EXPECT_EQ(answer.status, 200) << answer.body;
        const Json probed = answer.json();
        for (const Json& role : probed["roles"])
            if (role["name"] == "color") return role["values"].get<std::vector<float>>();
        return {};
    }
    std::vector<std::string> warnings(int frame) const {
        const Answer answer = get("/api/picture?frame=" + std::to_string(frame));
        return Json::parse(answer.header("X-Aftershade-Times"))["warnings"].get<std::vector<std::string>>();
    }
    std::map<std::string, ExrValue> attributes_;
    std::string third_ = "alpha";
};

TEST_F(ServeMixed, ShowsTheLayerOfTheFirstFrameAndSaysSo) {
    start();
    EXPECT_EQ(color(1), (std::vector<float>{0.1f, 0.2f, 0.3f, 0.4f}));
    EXPECT_EQ(color(2), (std::vector<float>{0.5f, 0.6f, 0.7f, 0.8f}));
    EXPECT_EQ(warnings(1), std::vector<std::string>{});
    EXPECT_EQ(warnings(2), std::vector<std::string>{
                               "it has the layers 'Beta' and 'Zeta'; 'Zeta' is read, as in in_0001.exr"});
}

TEST_F(ServeMixed, ShowsNoFrameWithoutThatLayer) {
    start();
    const Answer answer = get("/api/picture?frame=3");
    EXPECT_NE(answer.status, 200);
    EXPECT_NE(answer.body.find("in_0003.exr: has no layer 'Zeta', which the first frame, in_0001.exr"),
              std::string::npos)
        << answer.body;
    EXPECT_EQ(color(2)[0], 0.5f) << "the others are shown";
}

TEST_F(ServeMixed, ConvertsColorsToTheSpaceOfTheFirstFrame) {
    attributes_ = {{"chromaticities", kAcescgPrimaries}};
    start();
    Chromaticities stored{};
    std::ranges::copy(kAcescgPrimaries, stored.begin());
    Image expected(1, 1, 4);
    for (int c = 0; c < 4; ++c) expected.at(0, 0, c) = float(c + 5) / 10;
    convert_colors(expected, conversion_matrix(stored, kRec709));
    const std::vector<float> found = color(2);
    for (std::size_t c = 0; c < 4; ++c) EXPECT_NEAR(found[c], expected.floats()[c], 1e-5f);
}

TEST_F(ServeMixed, DecidesByTheSequencesFirstFrameWhichFramesItMayShow) {
    third_ = "Zeta";
    start({"--frames", "2-3"});
    EXPECT_EQ(color(2), (std::vector<float>{0.5f, 0.6f, 0.7f, 0.8f}));
    EXPECT_EQ(color(3), (std::vector<float>{0.1f, 0.2f, 0.3f, 0.4f}));
}

}  // namespace
}  // namespace aftershade::test
