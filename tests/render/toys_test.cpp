// The two effects of tests/effect/toys, which between them use every kind of pass.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "framework/effect/registry.h"
#include "framework/render/renderer.h"
#include "tests/backends.h"
#include "tests/synthetic_capture.h"

namespace aftershade::test {
namespace {

class Toys : public gpu::OnEachBackend {
protected:
    static Image run(const std::string& steps, const Capture& capture) {
        const std::filesystem::path root = AFTERSHADE_SOURCE_DIR;
        EffectRegistry effects({root / "tests/effect/toys"});
        Diagnostics faults;
        const auto node = parse_document(R"({"aftershade": 1, "steps": [)" + steps + "]}", "look", faults);
        const Pipeline pipeline = bind_pipeline(*parse_look(*node, faults), effects, {}, faults);
        EXPECT_FALSE(faults.has_errors());
        gpu::Context context(GetParam());
        PipelineRenderer renderer(context, pipeline, root);
        FrameInputs frame;
        frame.capture = &capture;
        return renderer.render(frame, {"color"}, false).images.at("color");
    }
};

TEST_P(Toys, ClassifyTilesIntoListsThatIndirectDrawsPaint) {
    SyntheticScene scene;
    scene.width = 45;  // the last column and row of tiles are cut
    scene.height = 27;
    scene.background = {0.1f, 0.1f, 0.1f};
    scene.box = SyntheticBox{10, 3, 9, 14, 0, 0, 2, {0.9f, 0.2f, 0.1f}};
    scene.points = {{44, 26, 3}, {0, 20, 0.35f}};
    const Capture capture = make_capture(scene);
    const Image& color = capture.images.at("color");
    const Image painted = run(R"({"effect": "tile_classify"})", capture);
    const int columns = (scene.width + 7) / 8;
    for (int y = 0; y < scene.height; ++y)
        for (int x = 0; x < scene.width; ++x) {
            float brightest = 0;
            for (int v = y / 8 * 8; v < std::min(y / 8 * 8 + 8, scene.height); ++v)
                for (int u = x / 8 * 8; u < std::min(x / 8 * 8 + 8, scene.width); ++u)
                    for (int c = 0; c < 3; ++c) brightest = std::max(brightest, color.at(u, v, c));
            const bool bright = brightest > 0.5f;
            ASSERT_EQ(painted.at(x, y, 0), bright ? 1.0f : 0.0f) << x << " " << y;
            ASSERT_EQ(painted.at(x, y, 1), float(y / 8 * columns + x / 8)) << x << " " << y;
            ASSERT_EQ(painted.at(x, y, 2), bright ? 0.0f : 1.0f) << x << " " << y;
        }
}

TEST_P(Toys, SplatForwardWithTheNearestWinning) {
    SyntheticScene scene;
    scene.width = 40;
    scene.height = 24;
    scene.background = {0.25f, 0.5f, 0.75f};
    scene.background_depth_m = 8;
    scene.box = SyntheticBox{6, 5, 8, 9, 7, -2, 2, {0.9f, 0.2f, 0.1f}};
    const Capture capture = make_capture(scene, 1);
    const Image& color = capture.images.at("color");
    const Image& velocity = capture.images.at("velocity");
    const Image& depth = capture.images.at("depth");
    // The same by hand, pixel after pixel: the nearest that lands on a place keeps it.
    Image expected = color;
    std::vector<float> nearest(std::size_t(scene.width * scene.height),
                               std::numeric_limits<float>::infinity());
    for (int y = 0; y < scene.height; ++y)
        for (int x = 0; x < scene.width; ++x) {
            const int to_x = x + int(velocity.at(x, y, 0)), to_y = y + int(velocity.at(x, y, 1));
            if (to_x < 0 || to_y < 0 || to_x >= scene.width || to_y >= scene.height) continue;
            float& best = nearest[std::size_t(to_y * scene.width + to_x)];
            if (depth.at(x, y, 0) >= best) continue;
            best = depth.at(x, y, 0);
            for (int c = 0; c < 4; ++c) expected.at(to_x, to_y, c) = color.at(x, y, c);
        }
    const Image splat = run(R"({"effect": "forward_splat"})", capture);
    for (int y = 0; y < scene.height; ++y)
        for (int x = 0; x < scene.width; ++x)
            for (int c = 0; c < 4; ++c)
                ASSERT_EQ(splat.at(x, y, c), expected.at(x, y, c)) << x << " " << y << " " << c;
}

ON_EACH_BACKEND(Toys);

}  // namespace
}  // namespace aftershade::test
