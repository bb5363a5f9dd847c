// What the antialiasing promises: on the renderer's scenes against their truth, and on what a capture may do
// wrong.
#include "effects/taa/taa_test.h"

#include <limits>

#include <gtest/gtest.h>

#include "framework/compare/metrics.h"
#include "framework/scene/samples.h"
#include "framework/scene/scene_renderer.h"
#include "tests/not_finite.h"
#include "tests/scene/scene_text.h"

namespace aftershade::test::taa {
namespace {

constexpr int kWidthPx = 160, kHeightPx = 90;

/// A scene's jittered frames and their truth.
class Film {
public:
    explicit Film(scene::Scene scene, int width_px = kWidthPx, int height_px = kHeightPx)
        : scene_(std::move(scene)), renderer_(scene_, width_px, height_px, 2) {}

    Capture frame(int number, bool jittered = true) const {
        return shot(number, number, jittered ? scene::halton_jitter_px(number) : std::array<double, 2>{});
    }
    /// Of what frame `moment` shows, at rest.
    Capture still(int number, int moment) const {
        Capture capture = shot(number, moment, scene::halton_jitter_px(number));
        set_velocity(capture, 0, 0);
        return capture;
    }
    Image truth(int number) const {
        scene::TruthSettings settings;
        settings.kinds.antialias = true;
        return renderer_.render_truth(number, settings);
    }

private:
    Capture shot(int number, int moment, std::array<double, 2> jitter_px) const {
        Capture capture = renderer_.render_capture(moment, moment, jitter_px);
        capture.header.frame = number;
        set_jitter(capture, jitter_px);
        return capture;
    }
    scene::Scene scene_;
    scene::SceneRenderer renderer_;
};

// ---- at rest ----

class TaaAtRest : public testing::TestWithParam<std::tuple<std::string, std::string>> {};
INSTANTIATE_TEST_SUITE_P(Scenes, TaaAtRest,
                         testing::Combine(testing::Values("camera_checker", "wheel", "bats"),
                                          testing::ValuesIn(rejections())),
                         [](const auto& test) {
                             return std::get<0>(test.param) + "_" + std::get<1>(test.param);
                         });

TEST_P(TaaAtRest, GainsWithEveryFourfoldOfFramesAndSixDbBySixteen) {
    constexpr int kMoment = 3;
    const auto& [id, mode] = GetParam();
    const Film film(scene::shipped_scene(id));
    const Image truth = film.truth(kMoment);
    TaaRun run(rejection(mode));
    std::vector<double> psnr_db;
    double best_single_db = 0;
    for (int number = 1; number <= 16; ++number) {
        const Capture capture = film.still(number, kMoment);
        best_single_db = std::max(best_single_db, display_psnr_db(truth, capture.images.at("color")));
        psnr_db.push_back(display_psnr_db(truth, run.color(capture)));
    }
    fmt::print("{} {}: best single frame {:.2f} dB; 1, 4, 8, 16 frames {:.2f} {:.2f} {:.2f} {:.2f} dB\n", id,
               mode, best_single_db, psnr_db[0], psnr_db[3], psnr_db[7], psnr_db[15]);
    EXPECT_GT(psnr_db[3], psnr_db[0]);
    EXPECT_GT(psnr_db[15], psnr_db[3]);
    EXPECT_GE(psnr_db[15], best_single_db + 6);
}

class TaaStatic : public testing::TestWithParam<std::tuple<std::string, bool>> {};
INSTANTIATE_TEST_SUITE_P(Modes, TaaStatic, testing::Combine(testing::ValuesIn(rejections()), testing::Bool()),
                         [](const auto& test) {
                             return std::get<0>(test.param) + (std::get<1>(test.param) ? "_hdr" : "");
                         });

TEST_P(TaaStatic, PictureWithoutJitterStaysAsItIsBitForBit) {
    const auto& [mode, hdr] = GetParam();
    const std::string params = rejection(mode) + fmt::format(R"(, "hdr_weighting": {})", hdr);
    for (const char* filter : {"none", "gaussian"}) {
        TaaRun run(params + fmt::format(R"(, "reconstruction": "{}", "static_frames": 6)", filter));
        Image first;
        for (int number = 1; number <= 12; ++number) {
            Capture capture = noise(48, 30, 4, 2, number);
            capture.images["color"].at(20, 12, 1) = 5e4f;  // a lone lamp
            const Image out = run.color(capture);
            if (number == 1) first = filter == std::string("none") ? capture.images.at("color") : out;
            ASSERT_TRUE(same_bits(first, out)) << filter << ", frame " << number;
        }
    }
}

// ---- in motion ----

/// The farthest, in px, from the box on the side that it left at which `out` differs from `wall`.
int trail_px(const Capture& capture, const Image& out, const Image& wall, double tolerance) {
    const Image& ids = capture.images.at("object_id");
    int longest = 0;
    for (int y = 0; y < out.height(); ++y) {
        int left = 0;
        while (left < out.width() && ids.uint_at(left, y, 0) != 2) ++left;
        if (left == out.width()) continue;
        for (int x = left - 1; x >= 0; --x)
            for (int c = 0; c < 3; ++c)
                if (!(std::abs(out.at(x, y, c) - wall.at(x, y, c)) <= tolerance))
                    longest = std::max(longest, left - x);
    }
    return longest;
}

class TaaTrail : public testing::TestWithParam<std::string> {
protected:
    static scene::Scene box_scene(bool plain) {
        scene::Scene scene = scene::shipped_scene("moving_box");
        if (plain)
            for (scene::Material& material : scene.materials) material.checker_cells = {0, 0};
        return scene;
    }
    static scene::Scene wall_scene(bool plain) {
        scene::Scene scene = box_scene(plain);
        scene.objects.pop_back();
        return scene;
    }
    static int longest_px(const std::string& params, bool plain, bool jittered) {
        const Film film(box_scene(plain), 320, 180), wall(wall_scene(plain), 320, 180);
        TaaRun run(params);
        int longest = 0;
        for (int number = 1; number <= 8; ++number) {
            const Capture capture = film.frame(number, jittered);
            const Image out = run.color(capture);
            const Image behind = wall.frame(number, jittered).images.at("color");
            longest = std::max(longest, trail_px(capture, out, behind, 2e-3));
        }
        return longest;
    }
};
INSTANTIATE_TEST_SUITE_P(Modes, TaaTrail, testing::Values("clamp", "clip", "variance_clip"),
                         [](const auto& mode) { return mode.param; });

TEST_P(TaaTrail, OfABoxEndsTwoPixelsBehindItOnACheckeredWall) {
    EXPECT_LE(longest_px(rejection(GetParam()) + R"(, "reconstruction": "none")", false, false), 2);
}

TEST_P(TaaTrail, OfAJitteredBoxEndsTwoPixelsBehindItOnAPlainWall) {
    EXPECT_LE(longest_px(rejection(GetParam()), true, true), 2);
    EXPECT_LE(longest_px(rejection(GetParam()) + R"(, "hdr_weighting": true)", true, true), 2);
}

TEST_P(TaaTrail, EndsThereWithoutDepthsHelpToo) {
    EXPECT_LE(longest_px(rejection(GetParam()) + R"(, "disocclusion": "none")", true, true), 2);
}

TEST(TaaTrailWithoutRejection, IsWhatDisocclusionLeaves) {
    struct Trail : TaaTrail {
        using TaaTrail::longest_px;
    };
    EXPECT_GT(Trail::longest_px(R"("rejection": "none", "disocclusion": "none")", true, true), 8);
}

TEST(TaaInMotion, GainsTwoDbUnderAMovingCamera) {
    const Film film(scene::shipped_scene("camera_checker"));
    constexpr int kLast = 8;
    const Image truth = film.truth(kLast);
    const double single_db = display_psnr_db(truth, film.frame(kLast, false).images.at("color"));
    for (const std::string& mode : rejections()) {
        TaaRun run(rejection(mode));
        double db = 0;
        for (int number = 1; number <= kLast; ++number)
            db = display_psnr_db(truth, run.color(film.frame(number)));
        fmt::print("{}: single frame {:.2f} dB, with history {:.2f} dB\n", mode, single_db, db);
        EXPECT_GE(db, single_db + 2) << mode;
    }
}

TEST(TaaInMotion, FollowsTheCameraWhereThereIsNoVelocity) {
    const Film film(scene::shipped_scene("camera_checker"));
    TaaRun with, without;
    for (int number = 1; number <= 6; ++number) {
        Capture capture = film.frame(number, false);
        with.next(capture);
        remove_role(capture, "velocity");
        without.next(capture);
    }
    double most_px = 0;
    for (std::size_t i = 0; i < with.tap("motion").floats().size(); i += 4)
        for (std::size_t axis = 0; axis < 2; ++axis) {
            const auto [v, w] =
                std::pair(with.tap("motion").floats()[i + axis], without.tap("motion").floats()[i + axis]);
            // Places that came into the picture have no motion.
            if (v != 0 && w != 0) most_px = std::max(most_px, double(std::abs(v - w)));
        }
    // Of a silhouette's closest pixel the motion is that at the pixel beside it.
    EXPECT_LT(most_px, 0.25);
    EXPECT_GT(std::abs(with.tap("motion").at(80, 45, 0)), 3);
}

// ---- what has no history ----

TEST(TaaHistoryOfAShot, BeginsAnewAtACut) {
    const Film film(scene::shipped_scene("wheel"));
    TaaRun used, fresh;
    for (int number = 1; number <= 4; ++number) used.next(film.frame(number));
    const Capture capture = film.frame(5);
    const Image after_cut = used.color(capture, true);
    EXPECT_TRUE(same_bits(after_cut, fresh.color(capture)));
    for (const float age : used.tap("age").floats()) ASSERT_EQ(age, 1);
}

/// A box of `velocity_x` px a frame, `depth_m` far, before a wall at 5 m: frames 1 and 2.
Image motion_behind(int velocity_x, float depth_m, const std::string& params = "") {
    TaaRun run(params);
    for (int number = 1; number <= 2; ++number)
        run.next(make_capture({.width = 48,
                               .height = 24,
                               .background_depth_m = 5,
                               .box = SyntheticBox{8, 6, 12, 12, velocity_x, 0, depth_m}},
                              number));
    return run.tap("motion");
}

TEST(TaaDisocclusion, DropsWhatTheBoxHidByDepth) {
    const Image motion = motion_behind(8, 2);
    // The box goes from [16, 28) to [24, 36): columns 16 to 22 are uncovered, 23 is beside the box, 15 was.
    for (int x = 0; x < 48; ++x) {
        EXPECT_EQ(std::abs(motion.at(x, 12, 3)), x == 15 ? 5 : x >= 16 && x < 23 ? 3 : 1) << x;
        EXPECT_EQ(motion.at(x, 12, 2), x >= 15 && x < 23 ? 0 : 1) << x;
    }
}

TEST(TaaDisocclusion, DropsWhatTheBoxHidById) {
    const Image motion = motion_behind(8, 5);
    for (int x = 0; x < 48; ++x) EXPECT_EQ(std::abs(motion.at(x, 12, 3)), x >= 16 && x < 23 ? 4 : 1) << x;
    const Image by_depth = motion_behind(8, 5, R"("disocclusion": "depth")");
    for (int x = 0; x < 48; ++x) EXPECT_EQ(std::abs(by_depth.at(x, 12, 3)), 1) << x;
}

TEST(TaaMotion, OfThePixelsAroundAnObjectIsTheObjects) {
    const Image motion = motion_behind(3, 2);
    // The box is at [14, 26) now.
    for (int x = 0; x < 48; ++x) EXPECT_EQ(motion.at(x, 12, 0), x >= 13 && x < 27 ? 3 : 0) << x;
}

// ---- what is no number ----

TEST(TaaFaults, MotionThatIsNoNumberOrLeadsOutsideHasNoHistory) {
    for (const float v : {kNan, kInfinity, -kInfinity, 300.0f, -1e30f, 3e38f}) {
        TaaRun run(R"("reconstruction": "none")");
        run.next(noise(48, 30, 1, 1, 1));
        Capture capture = noise(48, 30, 2, 1, 2);
        set_velocity(capture, v, 0);
        EXPECT_TRUE(same_bits(run.color(capture), capture.images.at("color"))) << v;
        for (const float age : run.tap("age").floats()) ASSERT_EQ(age, 1) << v;
    }
}

TEST(TaaFaults, ColorThatIsNoNumberStaysInItsPixelAndItsFrame) {
    for (const float bad : {kNan, kInfinity, -kInfinity, 3e38f}) {
        TaaRun clean(R"("rejection": "none", "reconstruction": "none")");
        TaaRun faulty(R"("rejection": "none", "reconstruction": "none")");
        for (int number = 1; number <= 5; ++number) {
            Capture capture = noise(48, 30, std::uint32_t(number), 1, number);
            const Image expected = clean.color(capture);
            if (number == 1 || number == 3) capture.images["color"].at(20, 12, number) = bad;
            const Image out = faulty.color(capture);
            ASSERT_TRUE(is_finite(out));
            for (int y = 0; y < 30; ++y)
                for (int x = 0; x < 48; ++x)
                    for (int c = 0; c < 4; ++c) {
                        if (x == 20 && y == 12) continue;
                        ASSERT_EQ(out.at(x, y, c), expected.at(x, y, c)) << x << " " << y;
                    }
        }
    }
}

TEST(TaaFaults, ColorThatIsNoNumberAnywhereGivesNumbersInEveryMode) {
    for (const std::string& mode : rejections())
        for (const char* filter : {"none", "gaussian", "blackman_harris"}) {
            TaaRun run(rejection(mode) +
                       fmt::format(R"(, "reconstruction": "{}", "hdr_weighting": true)", filter));
            for (int number = 1; number <= 3; ++number) {
                Capture capture = noise(24, 16, std::uint32_t(number), 1, number);
                for (int i = 0; i < 24 * 16; ++i)
                    if (i % 3 == number % 3 || number == 2)
                        capture.images["color"].floats()[std::size_t(4 * i + i % 4)] =
                            i % 2 ? kNan : kInfinity;
                ASSERT_TRUE(is_finite(run.color(capture))) << mode << " " << filter << " " << number;
            }
        }
}

}  // namespace
}  // namespace aftershade::test::taa
