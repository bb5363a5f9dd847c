// Real files of several Blenders through the command: effects, masks by an object's name, layers.
#include <bit>
#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "framework/base/error.h"
#include "framework/file/exr_file.h"
#include "tests/cli/command.h"
#include "tests/real_captures.h"
#include "tests/temporary_folder.h"

namespace aftershade::test {
namespace {

namespace fs = std::filesystem;
using Args = std::vector<std::string>;

/// "Suzanne" in the files' manifests.
constexpr std::uint32_t kSuzanneId = 0xcb432898;

const std::string kBrighterSuzanne = R"({"aftershade": 1, "steps": [
    {"effect": "color_grade", "params": {"exposure": 1}, "mask": {"object": ["Suzanne"]}}]})";

CommandResult run_look(const TemporaryFolder& folder, const std::string& look, Args args) {
    write_text(folder / "look.json", look);
    args.insert(args.begin(), {"run", (folder / "look.json").string()});
    args.insert(args.end(), {"--progress", "plain", "--backend", "software"});
    return run_aftershade(args, folder.path());
}

/// A channel of whichever part has it.
Image channel_of(const fs::path& path, const std::string& name) {
    const ExrFile file(path);
    for (int part = 0; part < int(file.parts().size()); ++part)
        for (const ExrChannel& channel : file.parts()[std::size_t(part)].channels)
            if (channel.name == name) return file.read_floats(part, std::vector<std::string>{name});
    ADD_FAILURE() << path << " has no " << name;
    return {};
}

/// By the specification: id and coverage in pairs, over all ranks.
std::vector<float> coverage_of_suzanne(const fs::path& path) {
    std::vector<float> coverage;
    for (const char* rank : {"00", "01", "02"})
        for (const auto& [id, amount] : {std::pair("r", "g"), std::pair("b", "a")}) {
            const std::string prefix = std::string("ViewLayer.CryptoObject") + rank + ".";
            const Image ids = channel_of(path, prefix + id), amounts = channel_of(path, prefix + amount);
            coverage.resize(ids.floats().size());
            for (std::size_t i = 0; i < coverage.size(); ++i)
                if (std::bit_cast<std::uint32_t>(ids.floats()[i]) == kSuzanneId)
                    coverage[i] += amounts.floats()[i];
        }
    return coverage;
}

class BlenderVersion : public testing::TestWithParam<const char*> {};

TEST_P(BlenderVersion, HasItsObjectsMaskedByNameAsFarAsTheyCoverAPixel) {
    AFTERSHADE_REQUIRE_CAPTURE(capture, std::string("blender-versions/") + GetParam() + "/multi_0003.exr");
    const TemporaryFolder folder;
    const CommandResult result =
        run_look(folder, kBrighterSuzanne, {capture->string(), "-o", "out.exr", "--pixel-type", "float"});
    ASSERT_EQ(result.exit_code, 0) << result.err;
    const Image before = channel_of(*capture, "ViewLayer.Combined.R"),
                after = channel_of(folder / "out.exr", "R");
    const std::vector<float> coverage = coverage_of_suzanne(*capture);
    int inside = 0, partly = 0;
    for (std::size_t i = 0; i < coverage.size(); ++i) {
        // One stop brighter where the object covers all; the mask is held as half.
        const float expected = before.floats()[i] * (1 + coverage[i]);
        ASSERT_NEAR(after.floats()[i], expected, 1e-3f * (1 + expected)) << i;
        inside += coverage[i] == 1;
        partly += coverage[i] > 0 && coverage[i] < 1;
    }
    EXPECT_GT(inside, 1000);
    EXPECT_GT(partly, 100);
}

TEST_P(BlenderVersion, HasAllThatEffectsOfScatteringNeed) {
    AFTERSHADE_REQUIRE_CAPTURE(capture, std::string("blender-versions/") + GetParam() + "/multi_0003.exr");
    for (const std::string effect : {"sss_separable", "sss_burley", "sss_exact", "sss_adaptive"}) {
        const TemporaryFolder folder;
        const CommandResult result =
            run_look(folder, R"({"aftershade": 1, "steps": [{"effect": ")" + effect + R"("}]})",
                     {capture->string(), "-o", "out.exr"});
        EXPECT_EQ(result.exit_code, 0) << effect << ": " << result.err;
    }
}

TEST_P(BlenderVersion, HasTheLayerThatIsNamedAndSaysWhichItTookItself) {
    AFTERSHADE_REQUIRE_CAPTURE(capture, std::string("blender-versions/") + GetParam() + "/layers.exr");
    const TemporaryFolder folder;
    const std::string empty = R"({"aftershade": 1, "steps": []})";
    const CommandResult first = run_look(folder, empty, {capture->string(), "-o", "first.exr"});
    EXPECT_NE(first.err.find("note: the file has the layers 'Far' and 'Near objects'; 'Far' is read"),
              std::string::npos)
        << first.err;
    const CommandResult near =
        run_look(folder, empty, {capture->string(), "-o", "near.exr", "--layer", "Near objects"});
    EXPECT_EQ(near.err.find("note:"), std::string::npos) << near.err;
    const Image stored = channel_of(*capture, "Near objects.Combined.G"),
                read = channel_of(folder / "near.exr", "G");
    for (std::size_t i = 0; i < stored.floats().size(); ++i)
        ASSERT_EQ(read.floats()[i], stored.floats()[i]) << i;
}

TEST_P(BlenderVersion, ReadsWhatAnEarlierRunWrote) {
    AFTERSHADE_REQUIRE_CAPTURE(capture, std::string("blender-versions/") + GetParam() + "/multi_0003.exr");
    const TemporaryFolder folder;
    const std::string look = R"({"aftershade": 1, "steps": [{"effect": "color_grade"}]})";
    ASSERT_EQ(run_look(folder, look, {capture->string(), "-o", "once.exr"}).exit_code, 0);
    const CommandResult again = run_look(folder, look, {"once.exr", "-o", "twice.exr"});
    ASSERT_EQ(again.exit_code, 0) << again.err;
    const Image once = channel_of(folder / "once.exr", "R"), twice = channel_of(folder / "twice.exr", "R");
    for (std::size_t i = 0; i < once.floats().size(); ++i)
        ASSERT_EQ(once.floats()[i], twice.floats()[i]) << i;
}

INSTANTIATE_TEST_SUITE_P(All, BlenderVersion, testing::Values("4.2.23", "5.2.3"), [](const auto& version) {
    return std::string(version.param[0] == '4' ? "Of4_2" : "Of5_2");
});

TEST(SingleLayerFile, ThatHasNoCryptomatteRefusesALookThatNamesObjects) {
    AFTERSHADE_REQUIRE_CAPTURE(capture, "blender-versions/5.2.3/single.exr");
    const TemporaryFolder folder;
    const CommandResult result = run_look(folder, kBrighterSuzanne, {capture->string(), "-o", "out.exr"});
    EXPECT_NE(result.exit_code, 0);
    EXPECT_NE(
        result.err.find("the look names the object 'Suzanne', but the file has neither a Cryptomatte nor "
                        "the role object_id; its header declares 'ViewLayer.CryptoObject'"),
        std::string::npos)
        << result.err;
    EXPECT_FALSE(fs::exists(folder / "out.exr"));
}

TEST(InspectedBlenderFile, ListsItsCryptomattesAndOnDemandTheirObjects) {
    AFTERSHADE_REQUIRE_CAPTURE(capture, "blender-versions/5.2.3/multi_0003.exr");
    const TemporaryFolder folder;
    const CommandResult result = run_aftershade(
        {"inspect", capture->string(), "--cryptomatte", "CryptoObject", "--json"}, folder.path());
    ASSERT_EQ(result.exit_code, 0) << result.err;
    const auto json = nlohmann::json::parse(result.out);
    ASSERT_EQ(json["cryptomattes"].size(), 2u);
    EXPECT_EQ(json["cryptomattes"][0]["name"], "ViewLayer.CryptoObject");
    double expected_px = 0;
    for (const float amount : coverage_of_suzanne(*capture)) expected_px += double(amount);
    EXPECT_NEAR(json["cryptomattes"][0]["objects"]["Suzanne"].get<double>(), expected_px, 1e-3 * expected_px);
    const CommandResult unnamed =
        run_aftershade({"inspect", capture->string(), "--json", "--cryptomatte"}, folder.path());
    ASSERT_EQ(unnamed.exit_code, 0) << unnamed.err;
    EXPECT_EQ(nlohmann::json::parse(unnamed.out)["cryptomattes"][0]["objects"],
              json["cryptomattes"][0]["objects"]);
}

}  // namespace
}  // namespace aftershade::test
