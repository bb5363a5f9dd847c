// The velocity check on frames of Blender and of OpenEXR's images.
#include "framework/file/exr_file.h"
#include "framework/inspect/velocity_check.h"
#include "framework/inspect/velocity_report.h"
#include "tests/inspect/velocity_pairs.h"
#include "tests/real_captures.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

namespace aftershade::test {
namespace {

namespace fs = std::filesystem;

/// Channels 0 and 1, or 2 and 3, of Blender's Vector, decoded here by hand: rows down, (-X, +Y) and (-Z, +W).
Image blender_vectors(const Image& vector, int first) {
    Image image(vector.width(), vector.height(), 2);
    for (int y = 0; y < vector.height(); ++y)
        for (int x = 0; x < vector.width(); ++x) {
            image.at(x, y, 0) = -vector.at(x, y, first);
            image.at(x, y, 1) = vector.at(x, y, first + 1);
        }
    return image;
}

Pair read_suzanne(const fs::path& folder, int frame = 3) {
    const std::vector<std::string> color = {"ViewLayer.Combined.R", "ViewLayer.Combined.G",
                                            "ViewLayer.Combined.B"};
    const std::vector<std::string> vector = {"ViewLayer.Vector.X", "ViewLayer.Vector.Y", "ViewLayer.Vector.Z",
                                             "ViewLayer.Vector.W"};
    const auto path = [&](int number) { return folder / ("gbuffer_000" + std::to_string(number) + ".exr"); };
    const ExrFile a(path(frame)), b(path(frame + 1));
    const Image vector_a = a.read_floats(0, vector), vector_b = b.read_floats(0, vector);
    return {a.read_floats(0, color),      b.read_floats(0, color),      blender_vectors(vector_a, 0),
            blender_vectors(vector_b, 0), blender_vectors(vector_a, 2), blender_vectors(vector_b, 2)};
}

void expect_confirmed(const VelocityCheck& check) {
    SCOPED_TRACE(format_velocity_check(check));
    EXPECT_TRUE(check.confirmed());
    EXPECT_GT(check.identity.score, 0.7);
    EXPECT_GT(check.identity.score - check.rival.score, 0.1);
    ASSERT_TRUE(check.fit && check.fit->scale_x && check.fit->scale_y);
    EXPECT_NEAR(*check.fit->scale_x, 1, 0.1);
    EXPECT_NEAR(*check.fit->scale_y, 1, 0.1);
    EXPECT_EQ(check.suggested, check.settings);
}

const VelocitySettings kBlenderVelocity{.delta = "prev-cur", .y_axis = "up"};
const VelocitySettings kBlenderNext{.delta = "cur-next", .y_axis = "up"};

TEST(VelocityCheckOnSuzanne, TheBlenderProfileIsConfirmed) {
    AFTERSHADE_REQUIRE_CAPTURE(folder, "suzanne/large");
    const Pair pair = read_suzanne(*folder);
    expect_confirmed(check_velocity(claim_velocity(pair, kBlenderVelocity)));
    VelocityCheckInput next = claim_next(pair);
    next.settings = kBlenderNext;
    expect_confirmed(check_velocity(next));
}

TEST(VelocityCheckOnSuzanne, TheFramesOfTheRepositoryConfirmItToo) {
    const Pair pair = read_suzanne(fs::path(AFTERSHADE_SOURCE_DIR) / "scenes/suzanne");
    expect_confirmed(check_velocity(claim_velocity(pair, kBlenderVelocity)));
    VelocityCheckInput next = claim_next(pair);
    next.settings = kBlenderNext;
    expect_confirmed(check_velocity(next));
}

TEST(VelocityCheckOnSuzanne, NoPairOfFramesSpeaksAgainstTheBlenderProfile) {
    // Among them one in which the ball enters the picture, one in which it hardly rises, and steady ones.
    AFTERSHADE_REQUIRE_CAPTURE(folder, "suzanne/small");
    int confirmed = 0;
    for (int frame = 1; frame <= 7; ++frame) {
        const Pair pair = read_suzanne(*folder, frame);
        VelocityCheckInput next = claim_next(pair);
        next.settings = kBlenderNext;
        for (const VelocityCheckInput& input : {claim_velocity(pair, kBlenderVelocity), next}) {
            const VelocityCheck check = check_velocity(input);
            EXPECT_TRUE(check.confirmed() || check.verdict == VelocityVerdict::undecided)
                << frame << ", " << format_velocity_check(check);
            EXPECT_EQ(check.suggested, input.settings);
            confirmed += check.confirmed();
        }
    }
    EXPECT_GE(confirmed, 9);  // of 14
}

/// Checks vectors decoded wrongly on purpose and returns the settings that the check suggests. Both roles
/// come to the same, as the truth of the wrong decoding is Blender's.
VelocitySettings suggestion(const Pair& pair, const VelocityHypothesis& mistake, bool next) {
    const Image a = undo(next ? pair.next_a : pair.velocity_a, mistake);
    const Image b = undo(next ? pair.next_b : pair.velocity_b, mistake);
    const VelocityCheck check = check_velocity(
        {&pair.color_a, &pair.color_b, &a, &b, {.delta = next ? "next-cur" : "cur-prev", .y_axis = "down"}});
    SCOPED_TRACE(format_velocity_check(check));
    EXPECT_EQ(check.verdict, VelocityVerdict::wrong);
    EXPECT_EQ(check.best.hypothesis, mistake);
    EXPECT_GT(check.hypotheses[0].score - check.hypotheses[1].score, 0.1);
    EXPECT_TRUE(check.untold.empty());
    return check.suggested;
}

TEST(VelocityCheckOnSuzanne, EveryMistakeIsNamedInTheProfilesWords) {
    AFTERSHADE_REQUIRE_CAPTURE(folder, "suzanne/large");
    const Pair pair = read_suzanne(*folder);
    for (const bool next : {false, true}) {
        const std::string right = next ? "next-cur" : "cur-prev", reversed = next ? "cur-next" : "prev-cur";
        EXPECT_EQ(suggestion(pair, {false, false, -1, -1}, next), (VelocitySettings{.delta = reversed}));
        EXPECT_EQ(suggestion(pair, {false, false, 1, -1}, next),
                  (VelocitySettings{.delta = right, .y_axis = "up"}));
        EXPECT_EQ(suggestion(pair, {false, false, -1, 1}, next),
                  (VelocitySettings{.delta = reversed, .y_axis = "up"}));
        EXPECT_EQ(suggestion(pair, {false, false, 0.5, 0.5}, next),
                  (VelocitySettings{.delta = right, .scale = {0.5, 0.5}}));
        EXPECT_EQ(suggestion(pair, {false, false, 2, 2}, next),
                  (VelocitySettings{.delta = right, .scale = {2, 2}}));
        EXPECT_EQ(suggestion(pair, {false, true, 1, 1}, next),
                  (VelocitySettings{.delta = right, .exchange_channels = true}));
    }
}

TEST(VelocityCheckOnSuzanne, VelocityAndVelocityNextAreToldFromEachOther) {
    AFTERSHADE_REQUIRE_CAPTURE(folder, "suzanne/large");
    const Pair pair = read_suzanne(*folder);
    const VelocityCheck next_as_velocity =
        check_velocity({&pair.color_a, &pair.color_b, &pair.next_a, &pair.next_b, {.delta = "cur-prev"}});
    EXPECT_EQ(next_as_velocity.verdict, VelocityVerdict::wrong);
    EXPECT_EQ(next_as_velocity.suggested.delta, "next-cur");
    EXPECT_NE(next_as_velocity.sentence.find("belong to role velocity_next"), std::string::npos);
    const VelocityCheck velocity_as_next = check_velocity(
        {&pair.color_a, &pair.color_b, &pair.velocity_a, &pair.velocity_b, {.delta = "next-cur"}});
    EXPECT_EQ(velocity_as_next.verdict, VelocityVerdict::wrong);
    EXPECT_EQ(velocity_as_next.suggested.delta, "cur-prev");
}

/// A part's channels in the grid of the display window, 0 outside.
Image read_part(const ExrFile& file, const std::string& name, const std::vector<std::string>& channels) {
    const auto& parts = file.parts();
    const auto part =
        std::find_if(parts.begin(), parts.end(), [&](const ExrPart& p) { return p.name == name; });
    const Image stored = file.read_floats(int(part - parts.begin()), channels);
    const Window& window = part->data_window;
    Image placed(part->display_window.width(), part->display_window.height(), stored.channels());
    for (int y = 0; y < stored.height(); ++y)
        for (int x = 0; x < stored.width(); ++x)
            for (int c = 0; c < stored.channels(); ++c)
                if (part->display_window.contains(window.min_x + x, window.min_y + y))
                    placed.at(window.min_x + x, window.min_y + y, c) = stored.at(x, y, c);
    return placed;
}

TEST(VelocityCheckOnBeachball, TheForwardVectorsNeedAScaleThatIsNotListed) {
    AFTERSHADE_REQUIRE_CAPTURE(folder, "beachball");
    const ExrFile a(*folder / "multipart.0003.exr"), b(*folder / "multipart.0004.exr");
    const Image color_a = read_part(a, "rgba_right", {"R", "G", "B"}),
                color_b = read_part(b, "rgba_right", {"R", "G", "B"});
    const Image forward_a = read_part(a, "forward_right", {"forward.u", "forward.v"});
    const Image forward_b = read_part(b, "forward_right", {"forward.u", "forward.v"});
    const VelocityCheck check =
        check_velocity({&color_a, &color_b, &forward_a, &forward_b, {.delta = "next-cur"}});
    SCOPED_TRACE(format_velocity_check(check));
    EXPECT_EQ(check.verdict, VelocityVerdict::no_fit);
    EXPECT_EQ(check.suggested.delta, "next-cur");
    EXPECT_EQ(check.suggested.y_axis, "down");
    ASSERT_TRUE(check.fit && check.fit->scale_x && check.fit->scale_y);
    // Mean forward: (42.0, -18.0). Measured apart from this code: the outline moves by (105.2, -22.5), that
    // is 2.50 and 1.25 times as much; the pattern on the turning ball by (112, -25.5), 2.67 and 1.42 times.
    EXPECT_GT(*check.fit->scale_x, 2.45);
    EXPECT_LT(*check.fit->scale_x, 2.75);
    EXPECT_GT(*check.fit->scale_y, 1.2);
    EXPECT_LT(*check.fit->scale_y, 1.55);
    EXPECT_GT(check.fit->score - check.best.score, 0.15);
}

}  // namespace
}  // namespace aftershade::test
