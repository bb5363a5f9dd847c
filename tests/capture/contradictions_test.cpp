// Files that contradict what is declared of them: a warning, and never a picture without a word.
#include <gtest/gtest.h>

#include <cmath>

#include "framework/capture/camera_metadata.h"
#include "tests/capture/capture_files.h"
#include "tests/capture/part_files.h"
#include "tests/file/deep_files.h"

namespace aftershade::test {
namespace {

using Names = std::vector<std::string>;

std::string joined(const Names& lines) {
    std::string text;
    for (const std::string& line : lines) text += line + "\n";
    return text;
}

/// What is said of a file with R, G, B and these channels, read by a profile with `roles`.
std::string said_of(const std::vector<StoredChannel>& more, const std::string& roles, const std::string& role,
                    const std::string& camera = "") {
    const TemporaryFolder folder;
    std::vector<StoredChannel> channels = more;
    for (const char* name : {"R", "G", "B"})
        channels.push_back({name, std::vector<float>(more[0].values.size(), 1)});
    write_channels(folder / "f.exr", 2, channels);
    Sequence sequence = sequence_of(folder / "f.exr", "t");
    if (!camera.empty()) sequence.camera.set("near", 0.1, "test"), sequence.camera.set("far", 100, "test");
    const Names asked = {role};
    return joined(CaptureReader(sequence, {profile_of_roles(roles)}, {}).read(1, asked).header.warnings);
}

TEST(Contradiction, OfADepthThatItsEncodingCannotHoldIsAWarning) {
    for (const char* encoding : {"z_buffer", "normalized"}) {
        const std::string roles =
            R"("depth": {"channels": ["Z"], "encoding": ")" + std::string(encoding) + "\"}";
        EXPECT_EQ(said_of({{"Z", {0, 0.5f, 1, 0.25f}}}, roles, "depth", "lens"), "") << encoding;
        const std::string said = said_of({{"Z", {2, 0.5f, 1, 0.25f}}}, roles, "depth", "lens");
        EXPECT_NE(said.find("outside of 0 to 1"), std::string::npos) << said;
        EXPECT_NE(said.find(encoding), std::string::npos) << said;
    }
    EXPECT_EQ(said_of({{"Z", {2, 0.5f, 1, 0.25f}}}, R"("depth": {"channels": ["Z"]})", "depth"), "");
}

TEST(Contradiction, OfAMaskThatCoversMoreThanAllIsAWarning) {
    const std::string roles = R"("mask": {"channels": ["m"]})";
    EXPECT_EQ(said_of({{"m", {0, 0.5f, 1, 0.25f}}}, roles, "mask"), "");
    for (const float value : {-0.5f, 255.0f})
        EXPECT_NE(said_of({{"m", {0, value, 1, 0}}}, roles, "mask").find("outside of 0 to 1"),
                  std::string::npos);
}

TEST(Contradiction, OfARolesFileWithPixelsOfAnotherShapeIsAWarning) {
    const TemporaryFolder folder;
    const Image values(2, 2, 1);
    const auto write = [&](const std::string& name, const Names& names, float aspect) {
        std::vector<ExrOutputChannel> channels;
        for (const std::string& channel : names)
            channels.push_back({channel, PixelType::float32, &values, 0});
        ExrWriteOptions options;
        options.data_window = options.display_window = {0, 0, 1, 1};
        options.pixel_aspect = aspect;
        write_exr(folder / name, channels, options);
    };
    write("f.exr", {"R", "G", "B"}, 2);
    Sequence sequence = sequence_of(folder / "f.exr", "t");
    sequence.role_files.insert_or_assign("depth", FramePattern((folder / "z.exr").string()));
    const auto warnings = [&] {
        return joined(CaptureReader(sequence, {profile_of_roles(R"("depth": {"channels": ["Z"]})")}, {})
                          .read_header(1)
                          .warnings);
    };
    write("z.exr", {"Z"}, 2);
    EXPECT_EQ(warnings(), "");
    write("z.exr", {"Z"}, 1);
    EXPECT_NE(warnings().find("pixel aspect 1, color from one with 2"), std::string::npos) << warnings();
}

TEST(Contradiction, OfACamerasAttributeThatIsNoLengthIsAWarning) {
    const TemporaryFolder folder;
    const auto faults = [&](const std::map<std::string, ExrValue>& attributes, const Camera& known = {}) {
        write_channels(folder / "f.exr", 1, {{"R", {0}}}, attributes);
        return joined(camera_faults(ExrFile(folder / "f.exr").parts()[0], profile_of_roles(""), known));
    };
    EXPECT_EQ(faults({{"focus", 4.0f}, {"aperture", 2.8f}, {"nominalFocalLength", 0.0f}}), "");
    EXPECT_NE(faults({{"focus", -4.0f}})
                  .find("attribute focus is below 0, so it does not give the camera's "
                        "focus_distance"),
              std::string::npos);
    EXPECT_NE(faults({{"nominalFocalLength", std::nanf("")}}).find("is not a number"), std::string::npos);
    EXPECT_NE(faults({{"aftershade/camera/f_number", std::string("f/8")}}).find("is not a number"),
              std::string::npos);
    Camera known;
    known.set("focus_distance", 4, "capture.json");
    EXPECT_EQ(faults({{"focus", -4.0f}}, known), "");
}

TEST(Contradiction, OfDeepSamplesWithoutADepthIsCounted) {
    const TemporaryFolder folder;
    const float nan = std::nanf("");
    write_deep(folder / "a.exr", deep_image(3, {"R", "G", "B", "A", "Z"},
                                            {{{0.1f, 0.1f, 0.1f, 1, 2}},
                                             {{0.2f, 0.2f, 0.2f, 0.5f, nan}, {0.4f, 0.4f, 0.4f, 1, 3}},
                                             {{0.2f, 0.2f, 0.2f, 1, 4}}}));
    const Sequence sequence = sequence_of(folder / "a.exr", "t");
    const Names roles = {"color"};
    const Capture capture =
        CaptureReader(sequence, {profile_of_roles(R"("depth": {"channels": ["Z"]})")}, {}).read(1, roles);
    ASSERT_TRUE(capture.non_finite.contains("depth"));
    EXPECT_EQ(capture.non_finite.at("depth").nan, 1u);
    EXPECT_EQ(capture.non_finite.at("depth").x, 1);
}

TEST(Contradiction, OfPartsOfWhichNoneIsCalledAPictureIsANote) {
    const TemporaryFolder folder;
    const Imath::Box2i window({0, 0}, {15, 7});
    const auto notes_of = [&](const std::string& first) {
        write_parts(folder / "f.exr",
                    {{first, "", {"R", "G", "B"}, window, 1}, {"specular", "", {"R", "G", "B"}, window, 2}});
        const Sequence sequence = sequence_of(folder / "f.exr", "t");
        return joined(CaptureReader(sequence, {profile_of_roles("")}, {}).read_header(1).notes);
    };
    EXPECT_EQ(notes_of("beauty"), "");
    EXPECT_NE(notes_of("diffuse").find("'specular' has them, too"), std::string::npos) << notes_of("diffuse");
}

}  // namespace
}  // namespace aftershade::test
