#include "framework/capture/decode.h"

#include <cmath>
#include <limits>
#include <string>

#include "framework/base/error.h"
#include "tests/capture/capture_files.h"

namespace aftershade {
namespace {

using test::decoded;
using test::StoredChannel;

constexpr float kInf = std::numeric_limits<float>::infinity();
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

std::vector<float> floats_of(const Image& image) {
    return {image.floats().begin(), image.floats().end()};
}

struct VelocityCase {
    std::string role;
    std::string conventions;
    float x, y;  ///< canonical
};

// A thing moves 3 px to the right and 2 px up in a frame, in canonical terms (+3, -2): rows count downwards.
// Each case stores x = 3 and y = 2 and says what its producer means by that.
const std::vector<VelocityCase> kVelocityCases = {
    {"velocity", R"("delta": "cur-prev", "y_axis": "up")", 3, -2},
    {"velocity", R"("delta": "cur-prev", "y_axis": "down")", 3, 2},
    {"velocity", R"("delta": "prev-cur", "y_axis": "up")", -3, 2},
    {"velocity", R"("delta": "prev-cur", "y_axis": "down")", -3, -2},
    {"velocity", R"("delta": "cur-prev")", 3, 2},
    {"velocity_next", R"("delta": "next-cur", "y_axis": "up")", 3, -2},
    {"velocity_next", R"("delta": "next-cur", "y_axis": "down")", 3, 2},
    {"velocity_next", R"("delta": "cur-next", "y_axis": "up")", -3, 2},
    {"velocity_next", R"("delta": "cur-next", "y_axis": "down")", -3, -2},
};

TEST(DecodeVelocity, BringsEachSignConventionToPixelsPerFrameWithYDown) {
    for (const VelocityCase& test : kVelocityCases) {
        const std::string declaration = R"({"channels": ["V.u", "V.v"], )" + test.conventions + "}";
        const Image image = decoded(test.role, declaration, {{"V.u", {3, 0}}, {"V.v", {2, 0}}});
        EXPECT_EQ(floats_of(image), (std::vector<float>{test.x, test.y, 0, 0}))
            << test.role << " " << test.conventions;
    }
}

TEST(DecodeVelocity, PutsNoMotionWhereTheFileHasNoNumber) {
    const Image image = decoded("velocity", R"({"channels": ["V.u", "V.v"], "delta": "prev-cur"})",
                                {{"V.u", {kNan, kInf, -1}}, {"V.v", {kNan, -kInf, 4}}});
    EXPECT_EQ(floats_of(image), (std::vector<float>{0, 0, 0, 0, 1, -4}));
}

TEST(DecodeVelocity, FindsPixelsWithoutMotionWhereverTheyStand) {
    // More pixels than are looked at together, and a last few that are fewer.
    constexpr std::size_t kPixels = 1541;
    const std::string way = R"({"channels": ["V.u", "V.v"], "delta": "prev-cur", "no_motion_above": 900})";
    for (const std::size_t odd : {std::size_t(0), std::size_t(511), std::size_t(512), kPixels - 1}) {
        std::vector<float> u(kPixels, 3), v(kPixels, 2000), expected;
        for (std::size_t i = 0; i < kPixels; ++i) v[i] = float(i);
        u[odd] = 901;
        if (odd > 0) v[odd - 1] = kNan;
        for (std::size_t i = 0; i < kPixels; ++i) {
            const bool moves = u[i] == 3 && v[i] == v[i];
            expected.insert(expected.end(), {moves ? -u[i] : 0, moves ? -v[i] : 0});
        }
        EXPECT_EQ(floats_of(decoded("velocity", way, {{"V.u", u}, {"V.v", v}})), expected) << odd;
    }
}

TEST(DecodeDepth, ScalesToMetresAndKeepsNothingHitInfinite) {
    const Image image = decoded("depth", R"({"channels": ["D"], "scale": 0.01, "no_hit": 1e10})",
                                {{"D", {250, 1e-3f, 1e10f, 2e10f, kInf, 9.9e9f}}});
    EXPECT_EQ(floats_of(image),
              (std::vector<float>{250 * 0.01f, 1e-3f * 0.01f, kInf, kInf, kInf, 9.9e9f * 0.01f}));
}

TEST(DecodeDepth, LeavesCanonicalDepthAlone) {
    const std::vector<float> stored = {1.25f, 1e10f, kInf, 3e38f};
    EXPECT_EQ(floats_of(decoded("depth", R"({"channels": ["Z"]})", {{"Z", stored}})), stored);
}

TEST(DecodeDepth, TakesWhatIsNoNumberForNothingHit) {
    const Image image = decoded("depth", R"({"channels": ["Z"], "scale": 2})", {{"Z", {kNan, 1}}});
    EXPECT_EQ(floats_of(image), (std::vector<float>{kInf, 2}));
}

TEST(DecodeIds, AreIntegersFromFloatHalfAndUintChannels) {
    const std::string declaration = R"({"channels": ["id"]})";
    const std::vector<float> whole = {0, 1, 2048, 3};
    for (const PixelType type : {PixelType::half, PixelType::float32, PixelType::uint32}) {
        const Image image = decoded("object_id", declaration, {{"id", whole, type}});
        ASSERT_EQ(image.type(), ComponentType::uint32);
        for (std::size_t i = 0; i < whole.size(); ++i)
            EXPECT_EQ(image.uints()[i], std::uint32_t(whole[i])) << pixel_type_name(type);
    }
    const Image large = decoded("object_id", declaration, {{"id", {4294967040.0f, 16777216}}});
    EXPECT_EQ(large.uints()[0], 4294967040U);
    EXPECT_EQ(large.uints()[1], 16777216U);
}

TEST(DecodeIds, ThatAreNotWholeNumbersNameValueAndPixel) {
    const auto message = [](float value) {
        // Pixel 5 of rows of 3 is (2, 1).
        return test::capture_error([&] {
            decoded("object_id", R"({"channels": ["id"]})", {{"id", {1, 2, 3, 4, 5, value}}}, 3);
        });
    };
    for (const float bad : {1.5f, -1.0f, kNan, kInf, 4294967296.0f}) {
        EXPECT_NE(message(bad).find("at pixel (2, 1) is not a whole number"), std::string::npos)
            << message(bad);
        EXPECT_NE(message(bad).find("f.exr: "), std::string::npos) << message(bad);
    }
    EXPECT_NE(message(1.5f).find("object id 1.5"), std::string::npos) << message(1.5f);
}

TEST(DecodeIds, AreTheSameBesideSmallAndLargeOnes) {
    std::vector<float> stored(3000, 7);
    stored[1023] = 16777216;
    stored[1024] = 4294967040.0f;
    stored[2500] = -0.0f;
    const Image image = decoded("object_id", R"({"channels": ["id"]})", {{"id", stored}});
    for (std::size_t i = 0; i < stored.size(); ++i)
        ASSERT_EQ(image.uints()[i], std::uint32_t(double(stored[i]))) << i;
    stored[2999] = 0.5f;
    const std::string message = test::capture_error([&] {
        decoded("object_id", R"({"channels": ["id"]})", {{"id", stored}}, 100);
    });
    EXPECT_NE(message.find("object id 0.500000 at pixel (99, 29)"), std::string::npos) << message;
}

TEST(DecodeRole, AddsUpTheLayersOfASum) {
    const std::vector<StoredChannel> stored = {{"dir.R", {1, 10}},  {"dir.G", {2, 20}},
                                               {"dir.B", {3, 30}},  {"ind.R", {0.5f, 0.25f}},
                                               {"ind.G", {0, -20}}, {"ind.B", {1, 2}}};
    const Image image = decoded(
        "irradiance", R"({"sum": [["dir.R", "dir.G", "dir.B"], ["ind.R", "ind.G", "ind.B"]]})", stored);
    EXPECT_EQ(floats_of(image), (std::vector<float>{1.5f, 2, 4, 10.25f, 0, 32}));
}

TEST(DecodeRole, KeepsTheOrderOfTheRoleAndNotOfTheFile) {
    const Image image = decoded("normal", R"({"channels": ["n.z", "n.x", "n.y"]})",
                                {{"n.x", {1}}, {"n.y", {2}}, {"n.z", {3}}});
    EXPECT_EQ(floats_of(image), (std::vector<float>{3, 1, 2}));
}

TEST(DecodeRole, GivesAColourWithoutAlphaAlphaOne) {
    const std::vector<StoredChannel> rgb = {{"R", {0.25f, 4}}, {"G", {0.5f, 5}}, {"B", {0.75f, 6}}};
    EXPECT_EQ(floats_of(test::read_role("color", test::profile_of_roles(""), rgb)),
              (std::vector<float>{0.25f, 0.5f, 0.75f, 1, 4, 5, 6, 1}));
    std::vector<StoredChannel> rgba = rgb;
    rgba.push_back({"A", {0, 0.5f}});
    EXPECT_EQ(floats_of(test::read_role("color", test::profile_of_roles(""), rgba)),
              (std::vector<float>{0.25f, 0.5f, 0.75f, 0, 4, 5, 6, 0.5f}));
}

TEST(DecodeRole, PassesAnAovThrough) {
    const Image image = decoded("aov:mist", R"({"channels": ["m.r", "m.g", "m.b", "m.a"]})",
                                {{"m.r", {-1}}, {"m.g", {2}}, {"m.b", {1e6f}}, {"m.a", {0}}});
    EXPECT_EQ(floats_of(image), (std::vector<float>{-1, 2, 1e6f, 0}));
}

TEST(DecodeRole, TakesHalfsAsTheFloatsTheyAre) {
    const Image image =
        decoded("mask", R"({"channels": ["m"]})", {{"m", {0.333251953125f, 65504, -0.0f}, PixelType::half}});
    EXPECT_EQ(floats_of(image), (std::vector<float>{0.333251953125f, 65504, 0}));
}

TEST(DecodeRole, IsTheSameOnSeveralThreads) {
    constexpr int kColumns = 1000, kRows = 900;
    Image vectors(kColumns, kRows, 2), depth(kColumns, kRows, 1);
    for (std::size_t i = 0; i < depth.floats().size(); ++i) {
        vectors.floats()[2 * i] = float(i % 977) - 300;
        vectors.floats()[2 * i + 1] = i % 70001 == 13 ? kNan : float(i % 31);
        depth.floats()[i] = i % 3001 == 0 ? kInf : float(i % 5003) / 10;
    }
    RoleDecoding decoding;
    decoding.velocity_scale = {0.25, -2};
    decoding.no_motion_above = 670;
    decoding.encoding = DepthEncoding::inverse;
    decoding.scale = 3;
    DecodeContext one, four;
    four.threads = 4;
    Image vectors_of_one = vectors, depth_of_one = depth;
    EXPECT_EQ(decode_velocity(vectors, decoding, four), decode_velocity(vectors_of_one, decoding, one));
    EXPECT_EQ(floats_of(vectors), floats_of(vectors_of_one));
    decode_depth(depth, decoding, four);
    decode_depth(depth_of_one, decoding, one);
    EXPECT_EQ(floats_of(depth), floats_of(depth_of_one));
}

TEST(DecodeRole, JudgesEachDepthOfARunByItself) {
    // Runs in which all hit something take a shorter way than those in which one did not.
    for (const bool zero_is_no_hit : {false, true})
        for (const double scale : {1.0, 0.5}) {
            RoleDecoding decoding;
            decoding.zero_is_no_hit = zero_is_no_hit;
            decoding.scale = float(scale);
            decoding.no_hit = 1000;
            Image depth(5000, 1, 1);
            for (std::size_t i = 0; i < depth.floats().size(); ++i) depth.floats()[i] = float(i % 900) + 1;
            const std::vector<std::pair<std::size_t, float>> odd = {
                {0, 0.0f}, {1500, kNan}, {1501, 1000.0f}, {3072, -2.0f}, {4999, kInf}};
            for (const auto& [at, z] : odd) depth.floats()[at] = z;
            std::vector<float> expected(depth.floats().begin(), depth.floats().end());
            for (float& z : expected)
                z = std::isnan(z) || z >= 1000 || (zero_is_no_hit && z == 0) ? kInf : z * float(scale);
            decode_depth(depth, decoding, {});
            EXPECT_EQ(floats_of(depth), expected) << zero_is_no_hit << scale;
        }
}

TEST(DecodeRole, NamesTheFirstIdThatIsNoneOnAnyNumberOfThreads) {
    constexpr int kColumns = 1000, kRows = 900;
    Image ids(kColumns, kRows, 1);
    for (std::size_t i = 0; i < ids.floats().size(); ++i) ids.floats()[i] = float(i);
    const Image decoded = decode_ids(ids, "f.exr", 4);
    for (std::size_t i = 0; i < ids.floats().size(); ++i) ASSERT_EQ(decoded.uints()[i], i);
    // The later one is met first where each thread has a part of its own.
    ids.at(7, 220, 0) = 1.5f;
    ids.at(0, 450, 0) = 2.5f;
    for (const int threads : {1, 2, 4}) {
        try {
            decode_ids(ids, "f.exr", threads);
            ADD_FAILURE() << threads << " threads took an id of 1.5";
        } catch (const Error& error) {
            EXPECT_NE(std::string(error.what()).find("1.500000 at pixel (7, 220)"), std::string::npos)
                << error.what();
        }
    }
}

}  // namespace
}  // namespace aftershade
