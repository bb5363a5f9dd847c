// Names of numbers in object_id, by capture.json's "objects".
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "framework/base/error.h"
#include "framework/capture/cryptomatte.h"
#include "tests/capture/capture_files.h"
#include "tests/temporary_folder.h"

namespace aftershade {
namespace {

/// A row of the numbers 0 to 3, of which 1 and 3 have names.
struct Named {
    Named() {
        test::write_channels(folder / "f.exr", 4,
                             {{"R", {0, 0, 0, 0}},
                              {"G", {0, 0, 0, 0}},
                              {"B", {0, 0, 0, 0}},
                              {"object_id.I", {0, 1, 2, 3}, PixelType::uint32}});
        test::write_text(folder / "capture.json",
                         R"({"aftershade": 1, "frames": "f.exr", "objects": {"head": 1, "bar": 3}})");
        Diagnostics diagnostics;
        sequence = *open_sequence((folder / "capture.json").string(), diagnostics);
        EXPECT_EQ(test::lines_of(diagnostics), test::Lines{});
        profiles = read_profiles(AFTERSHADE_SOURCE_DIR "/profiles", diagnostics);
    }
    Capture read(const RoleId& role) const {
        const std::vector<RoleId> roles = {role};
        return CaptureReader(sequence, profiles, {}).read(sequence.frames.front(), roles);
    }
    std::vector<std::uint32_t> ids() const {
        const Capture capture = read("object_id");
        const auto values = capture.images.at("object_id").uints();
        return {values.begin(), values.end()};
    }
    test::TemporaryFolder folder;
    Sequence sequence;
    std::vector<Profile> profiles;
};

using Ids = std::vector<std::uint32_t>;

TEST(NamesOfNumbers, BecomeTheHashesThatALookLooksFor) {
    Named capture;
    EXPECT_EQ(capture.ids(), (Ids{0, 1, 2, 3})) << "nothing is named";
    capture.sequence.object_names = {"head"};
    EXPECT_EQ(capture.ids(), (Ids{0, cryptomatte_hash("head"), 2, 3}));
}

TEST(NamesOfNumbers, AreRefusedByTheNamesThatThereAre) {
    Named capture;
    capture.sequence.object_names = {"head", "bra"};
    const std::string message = test::capture_error([&] { capture.ids(); });
    EXPECT_NE(
        message.find("the look names the object 'bra', but \"objects\" of capture.json has no such name; did "
                     "you mean 'bar'? (it has 'bar' and 'head')"),
        std::string::npos)
        << message;
}

TEST(NamesOfNumbers, GiveMasksTheirCoverage) {
    Named capture;
    const std::vector<TableKey> objects = {{0, 0, "bar"}, {2, 2, ""}};
    for (const std::vector<std::string>& also_in_parameters : {std::vector<std::string>{}, {"bar"}}) {
        capture.sequence.object_names = also_in_parameters;
        const Capture read = capture.read(RoleId::coverage(objects));
        const auto values = read.images.at(RoleId::coverage(objects)).floats();
        EXPECT_EQ((std::vector<float>{values.begin(), values.end()}), (std::vector<float>{0, 0, 1, 1}));
    }
}

}  // namespace
}  // namespace aftershade
