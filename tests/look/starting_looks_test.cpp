// The looks that the program ships to start from.
#include "framework/look/starting_looks.h"

#include <algorithm>
#include <filesystem>

#include <gtest/gtest.h>

#include "tests/temporary_folder.h"

namespace aftershade::test {
namespace {

const std::filesystem::path kSource = AFTERSHADE_SOURCE_DIR;

EffectRegistry shipped() {
    return EffectRegistry({kSource / "effects"});
}

CaptureHeader header_with(std::vector<std::string> roles) {
    CaptureHeader header;
    header.roles = std::move(roles);
    return header;
}

TEST(StartingLooks, AreTenAtMostAndSoundAndFitACaptureOfDepthAndMotion) {
    EffectRegistry effects = shipped();
    const auto looks = find_starting_looks(starting_looks_folder(kSource), effects,
                                           header_with({"color", "depth", "velocity"}));
    const auto files = std::distance(std::filesystem::directory_iterator(kSource / "looks"), {});
    EXPECT_EQ(std::ptrdiff_t(looks.size()), files) << "one has faults";
    EXPECT_LE(looks.size(), 10u);
    for (const StartingLook& look : looks) {
        EXPECT_TRUE(look.missing.empty()) << look.name();
        EXPECT_GT(look.summary.size(), 10u) << look.name();
    }
}

TEST(StartingLooks, ThatNeedAnotherRoleComeLastAndNameIt) {
    EffectRegistry effects = shipped();
    const auto looks =
        find_starting_looks(starting_looks_folder(kSource), effects, header_with({"color", "depth"}));
    const auto fits = [](const StartingLook& look) { return look.missing.empty(); };
    EXPECT_TRUE(std::ranges::is_partitioned(looks, fits));
    const auto of = [&](const std::string& name) {
        return *std::ranges::find(looks, name, &StartingLook::name);
    };
    EXPECT_TRUE(fits(of("noir")));
    EXPECT_TRUE(fits(of("portrait")));
    ASSERT_EQ(of("action").missing.size(), 1u);
    EXPECT_EQ(of("action").missing[0].role, "velocity");
    const auto of_color =
        find_starting_looks(starting_looks_folder(kSource), effects, header_with({"color"}));
    const auto portrait = std::ranges::find(of_color, std::string("portrait"), &StartingLook::name);
    ASSERT_EQ(portrait->missing.size(), 1u);
    EXPECT_EQ(portrait->missing[0].role, "depth");
}

TEST(StartingLooks, LeaveOutWhatIsNoLookAndMayBeAbsent) {
    EffectRegistry effects = shipped();
    const TemporaryFolder folder;
    EXPECT_TRUE(find_starting_looks(folder / "none", effects, {}).empty());
    write_text(folder / "broken.json", "{");
    write_text(folder / "other.json", R"({ "aftershade": 1, "steps": [ { "effect": "nowhere" } ] })");
    write_text(folder / "notes.txt", "");
    EXPECT_TRUE(find_starting_looks(folder.path(), effects, {}).empty());
}

}  // namespace
}  // namespace aftershade::test
