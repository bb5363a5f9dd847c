// Statistics of textures: what they may say, and what is wrong with the rest.
#include "tests/effect/broken_manifests.h"

namespace aftershade {
namespace {

using test::EffectFolder;
using test::kMore;
using test::Lines;

TEST(ManifestTelemetry, KeepsAllThatItSays) {
    const EffectFolder folder(test::demo_manifest({{kMore, R"("telemetry": {
        "reach": {"of": "small.r", "where": "small.r", "bins": [0, 64.5, 8], "squared": true, "doc": "px"}})"}}));
    const EffectManifest manifest = folder.sound_manifest();
    ASSERT_EQ(manifest.telemetry.size(), 1U);
    const TelemetrySpec& reach = manifest.telemetry[0];
    EXPECT_EQ(reach.of.text(), "small.r");
    ASSERT_TRUE(reach.where);
    EXPECT_EQ(reach.where->text(), "small.r");
    EXPECT_TRUE(reach.squared);
    EXPECT_EQ(reach.from, 0);
    EXPECT_EQ(reach.to, 64.5);
    EXPECT_EQ(reach.bins, 8);
    EXPECT_EQ(reach.doc, "px");
}

std::string statistic(const std::string& fields) {
    return R"("telemetry": {"reach": {)" + fields + "}}";
}

TEST(ManifestTelemetry, SaysWhatIsWrong) {
    const std::vector<std::pair<std::string, Lines>> broken = {
        {R"("doc": ".")", {"8: statistic 'reach' has no 'of'"}},
        {R"("of": "smal.r")",
         {"8: statistic 'reach', of: 'smal' is not a texture of the effect with one layer of floats; did you "
          "mean "
          "'small'? (known: 'small')"}},
        {R"("of": "small.x")",
         {"8: statistic 'reach', of: 'small.x' must end in a channel of 'small', one of rgba: \"small.r\""}},
        {R"("of": "small.r", "bins": [0, 4])", {"8: 'bins' is [from, to, count], three numbers: [0, 64, 8]"}},
        {R"("of": "small.r", "bins": [4, 4, 2])",
         {"8: 'bins' must go up: its second number is not above its first"}},
        {R"("of": "small.r", "bins": [0, 4, 0.5])",
         {"8: 'bins' has 0.5 bins, but an integer from 1 to 1024 is needed"}},
        {R"("of": "small.r", "mean": true)", {"8: statistic 'reach' has no key 'mean'"}},
    };
    for (const auto& [fields, messages] : broken) test::expect_faults({{kMore, statistic(fields)}}, messages);
}

}  // namespace
}  // namespace aftershade
