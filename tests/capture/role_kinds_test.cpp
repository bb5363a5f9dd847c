// Every role, and one that is passed through, in the hands of all that treat roles by their kind. A role that
// is added to the table is held to its kind here by itself.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

#include "framework/capture/capture_grammar.h"
#include "framework/capture/capture_window.h"
#include "framework/capture/capture_writer.h"
#include "framework/capture/decode.h"
#include "framework/capture/encode_role.h"
#include "framework/capture/profile.h"
#include "framework/document/grammar.h"
#include "framework/image/false_color.h"
#include "framework/image/role.h"
#include "tests/documents.h"

namespace aftershade {
namespace {

std::vector<ChannelRole> all_roles() {
    std::vector<ChannelRole> roles(channel_roles().begin(), channel_roles().end());
    roles.push_back(*find_role("aov:mist"));
    return roles;
}

class EveryRole : public testing::TestWithParam<ChannelRole> {
protected:
    const ChannelRole& role() const { return GetParam(); }
    RoleKind kind() const { return GetParam().kind; }

    /// All pixels alike but for the one at (1, 1), the middle of the first block of 2 x 2.
    Image image(float usual, float middle) const {
        Image made(4, 4, role().channels, role().type);
        for (int y = 0; y < 4; ++y)
            for (int x = 0; x < 4; ++x)
                for (int c = 0; c < role().channels; ++c) {
                    const float value = x == 1 && y == 1 ? middle : usual;
                    if (role().type == ComponentType::uint32) made.uint_at(x, y, c) = std::uint32_t(value);
                    else made.at(x, y, c) = value;
                }
        return made;
    }

    static float value(const Image& image, int x, int y, int c) {
        return image.type() == ComponentType::uint32 ? float(image.uint_at(x, y, c)) : image.at(x, y, c);
    }

    Capture capture_of(Image pixels) const {
        Capture capture;
        capture.header.data_window = capture.header.display_window = {0, 0, 3, 3};
        capture.images.emplace(role().name, std::move(pixels));
        return capture;
    }

    /// The decoding of channels named c0, c1, ... with more keys.
    RoleDecoding decoding(const std::string& more, Diagnostics& diagnostics) const {
        std::string names;
        for (int c = 0; c < role().channels; ++c) names += (c ? ", \"c" : "\"c") + std::to_string(c) + "\"";
        const std::string text = "{\"channels\": [" + names + "]" + more + "}";
        grammar::check(test::parsed(text), decoding_block(role().name), diagnostics);
        return read_decodings(test::parsed("{\"" + role().name + "\": " + text + "}")).at(role().name);
    }
};

INSTANTIATE_TEST_SUITE_P(Roles, EveryRole, testing::ValuesIn(all_roles()), [](const auto& role) {
    std::string name = role.param.name;
    std::replace(name.begin(), name.end(), ':', '_');
    return name;
});

TEST(RoleKinds, EachHasARole) {
    const auto roles = all_roles();
    for (const RoleKind kind : kRoleKinds)
        EXPECT_NE(std::ranges::find(roles, kind, &ChannelRole::kind), roles.end()) << int(kind);
}

TEST_P(EveryRole, HasTheTraitsOfItsKind) {
    const bool is_id = kind() == RoleKind::id;
    EXPECT_EQ(kind_of_role(role().name), kind());
    EXPECT_EQ(role().type == ComponentType::uint32, is_id);
    EXPECT_EQ(std::isinf(role().outside), kind() == RoleKind::distance);
    EXPECT_EQ(role().filterable && (is_id || kind() == RoleKind::distance || kind() == RoleKind::motion),
              false)
        << "the mean of two ids, depths or vectors is of no surface";
    EXPECT_EQ(role().native_channels.size(), std::size_t(role().channels));
    const bool is_motion = kind() == RoleKind::motion, is_light = kind() == RoleKind::light;
    EXPECT_TRUE(is_motion || !role().to_next);
    EXPECT_TRUE(is_light || !role().is_share);
    EXPECT_TRUE(!is_motion || role().channels == 2);
}

TEST_P(EveryRole, IsScaledAsItsKindIs) {
    Capture capture = capture_of(image(2, 10));
    scale_capture(capture, 2);
    const Image& scaled = capture.images.at(role().name);
    ASSERT_EQ(scaled.width(), 2);
    for (int c = 0; c < role().channels; ++c) {
        const float of_block = role().filterable ? (3 * 2.0f + 10) / 4 : 10;
        EXPECT_EQ(value(scaled, 0, 0, c), kind() == RoleKind::motion ? 10 / 2.0f : of_block);
        EXPECT_EQ(value(scaled, 1, 1, c), kind() == RoleKind::motion ? 2 / 2.0f : 2);
    }
}

TEST_P(EveryRole, IsCroppedPixelByPixel) {
    Capture capture = capture_of(image(2, 10));
    crop_capture(capture, {1, 1, 9, 9});
    const Image& cropped = capture.images.at(role().name);
    ASSERT_EQ(cropped.width(), 3);
    for (int c = 0; c < role().channels; ++c) {
        EXPECT_EQ(value(cropped, 0, 0, c), 10);
        EXPECT_EQ(value(cropped, 1, 0, c), 2);
    }
}

TEST_P(EveryRole, HasColoursAndSaysWhatTheyMean) {
    const Image pixels = image(0.25f, 0.5f);
    const FalseColor colors(role().name, pixels, {});
    EXPECT_FALSE(colors.label()[0].empty());
    EXPECT_FALSE(colors.label()[1].empty());
    for (const float component : colors.color(1, 1)) EXPECT_TRUE(component >= 0 && component <= 1);
    EXPECT_EQ(colors.fault(1, 1), PixelFault::none);
    EXPECT_EQ(colors.legend(), kind() == RoleKind::distance ? Legend::ramp
                               : kind() == RoleKind::motion ? Legend::wheel
                                                            : Legend::none);
    EXPECT_EQ(colors.is_blendable(), kind() != RoleKind::id);
    const bool is_exposed = colors.label()[1].find("EV") != std::string::npos;
    EXPECT_EQ(is_exposed, role().channels > 2 && !role().is_share && kind() != RoleKind::direction &&
                              kind() != RoleKind::place);
}

TEST_P(EveryRole, IsFaultyWhereItsKindCannotBe) {
    if (kind() == RoleKind::id) return;
    const Image infinite = image(2, std::numeric_limits<float>::infinity()), negative = image(2, -10);
    EXPECT_EQ(FalseColor(role().name, infinite, {}).fault(1, 1),
              kind() == RoleKind::distance ? PixelFault::none : PixelFault::infinite);
    const bool has_signs = kind() == RoleKind::motion || kind() == RoleKind::direction ||
                           kind() == RoleKind::place || kind() == RoleKind::other;
    EXPECT_EQ(FalseColor(role().name, negative, {}).fault(1, 1),
              has_signs ? PixelFault::none : PixelFault::negative);
}

TEST_P(EveryRole, IsDecodedByItsKindsKeysAndNoOthers) {
    const auto is_fine = [&](const std::string& key) {
        Diagnostics diagnostics;
        decoding(", " + key, diagnostics);
        return !diagnostics.has_errors();
    };
    Diagnostics plain;
    decoding("", plain);
    EXPECT_EQ(test::lines_of(plain), test::Lines{});
    EXPECT_EQ(is_fine(R"("encoding": "inverse")"), kind() == RoleKind::distance);
    EXPECT_EQ(is_fine(R"("shutter_frames": 2)"), kind() == RoleKind::motion);
    EXPECT_EQ(is_fine(R"("delta": "prev-cur")"), kind() == RoleKind::motion && !role().to_next);
    EXPECT_EQ(is_fine(R"("delta": "cur-next")"), kind() == RoleKind::motion && role().to_next);
    EXPECT_EQ(is_fine(R"("luminance": "Y")"), role().has_optional_alpha());
}

TEST_P(EveryRole, IsEncodedToWhatIsDecoded) {
    Diagnostics diagnostics;
    const std::string conventions = kind() == RoleKind::distance ? R"(, "encoding": "inverse", "scale": 2)"
                                    : kind() == RoleKind::motion ? R"(, "y_axis": "up", "shutter_frames": 2)"
                                                                 : "";
    const RoleDecoding convention = decoding(conventions, diagnostics);
    ASSERT_EQ(test::lines_of(diagnostics), test::Lines{});
    FoundChannels names(1);
    for (int c = 0; c < role().channels; ++c) names[0].push_back("c" + std::to_string(c));
    const Image canonical = image(2, 10);
    const auto stored = encode_role(role().name, canonical, convention, names, false, {});
    ASSERT_EQ(stored.size(), std::size_t(role().channels));
    Image back(4, 4, role().channels);
    for (int c = 0; c < role().channels; ++c)
        for (std::size_t i = 0; i < 16; ++i)
            back.floats()[i * std::size_t(role().channels) + std::size_t(c)] =
                stored.at(names[0][std::size_t(c)]).floats()[i];
    EXPECT_EQ(value(back, 1, 1, 0), kind() == RoleKind::distance ? 0.2f
                                    : kind() == RoleKind::motion ? 20
                                                                 : 10);
    if (kind() == RoleKind::distance) decode_depth(back, convention);
    if (kind() == RoleKind::motion) decode_velocity(back, convention);
    if (kind() == RoleKind::id) back = decode_ids(back, "file");
    for (int c = 0; c < role().channels; ++c) EXPECT_EQ(value(back, 1, 1, c), 10);
}

}  // namespace
}  // namespace aftershade
