// Data in files that a compression stored with loss: said where it lost, read where it did not.
#include <gtest/gtest.h>

#include "framework/file/exr_loss.h"
#include "tests/capture/capture_files.h"

namespace aftershade::test {
namespace {

/// Numbers that need all bits of their type: nothing short of a whole number of bits stores them.
Image noise(PixelType type) {
    const bool is_uint = type == PixelType::uint32;
    Image image(70, 300, 1, is_uint ? ComponentType::uint32 : ComponentType::float32);
    std::uint32_t state = 1;
    for (std::size_t i = 0; i < std::size_t(70 * 300); ++i) {
        state = state * 1664525u + 1013904223u;
        const float value = float(state >> 8) * 1e-4f - 700;
        if (is_uint) image.uints()[i] = state;
        else if (type == PixelType::float32) image.floats()[i] = value;
        else image.floats()[i] = float((state >> 20) % 2048);  // what a half holds
    }
    return image;
}

/// One channel through a file, beside others that make it one of a picture.
bool comes_back(const std::string& compression, const std::string& name, PixelType type) {
    const TemporaryFolder folder;
    const Image image = noise(type);
    std::vector<ExrOutputChannel> channels = {{name, type, &image, 0}};
    for (const char* other : {"R", "G", "B"})
        if (name != other) channels.push_back({other, type, &image, 0});
    ExrWriteOptions options;
    options.data_window = options.display_window = {0, 0, 69, 299};
    options.compression = compression;
    write_exr(folder / "f.exr", channels, options);
    const ExrFile file(folder / "f.exr");
    const std::vector<std::string> one = {name};
    if (type == PixelType::uint32) return std::ranges::equal(file.read_uints(0, one).uints(), image.uints());
    return std::ranges::equal(file.read_floats(0, one).floats(), image.floats());
}

TEST(Loss, IsOfTheChannelsThatALibraryChangesAsItWritesThem) {
    for (const std::string& compression : exr_compression_names())
        for (const PixelType type : {PixelType::half, PixelType::float32, PixelType::uint32})
            for (const char* name : {"R", "G", "B", "Y", "RY", "BY", "A", "Z", "X", "r", "y", "v.Y", "v.R",
                                     "v.r", "v.X", "id.I", "mask.V"}) {
                const bool may_lose = loses_bits(compression, name, type);
                // lj2k loses of a whole triple R, G, B alone.
                if (compression == "lj2k" && may_lose) continue;
                EXPECT_EQ(comes_back(compression, name, type), !may_lose)
                    << compression << " " << name << " " << pixel_type_name(type);
            }
    EXPECT_TRUE(loses_bits("lj2k", "CryptoObject00.r", PixelType::float32));
    EXPECT_FALSE(loses_bits("htj2k32", "v.R", PixelType::float32));
}

std::string warnings_of(const std::string& compression, const std::string& channel, const std::string& role,
                        PixelType type = PixelType::float32) {
    const TemporaryFolder folder;
    const Image image(8, 8, 1);
    std::vector<ExrOutputChannel> channels = {{channel, type, &image, 0}};
    for (const char* other : {"R", "G", "B"}) channels.push_back({other, PixelType::half, &image, 0});
    ExrWriteOptions options;
    options.data_window = options.display_window = {0, 0, 7, 7};
    options.compression = compression;
    write_exr(folder / "f.exr", channels, options);
    const Sequence sequence = sequence_of(folder / "f.exr", "t");
    const Profile profile = profile_of_roles("\"" + role + R"(": {"channels": [")" + channel + "\"]}");
    std::string text;
    for (const std::string& warning : CaptureReader(sequence, {profile}, {}).read_header(1).warnings)
        text += warning + "\n";
    return text;
}

TEST(Loss, OfDataIsAWarningThatNamesTheChannels) {
    const std::string depth = warnings_of("dwab", "VRayZDepth.R", "depth");
    EXPECT_NE(depth.find("depth is read from 'VRayZDepth.R', stored with loss (dwab)"), std::string::npos)
        << depth;
    EXPECT_NE(warnings_of("pxr24", "Z", "depth").find("pxr24"), std::string::npos);
    EXPECT_NE(warnings_of("b44", "mask.V", "mask", PixelType::half).find("b44"), std::string::npos);
    EXPECT_NE(warnings_of("dwaa", "ids.R", "object_id").find("object_id"), std::string::npos);
}

TEST(Loss, IsNotSaidOfDataThatLostNothing) {
    EXPECT_EQ(warnings_of("dwab", "Z", "depth"), "");
    EXPECT_EQ(warnings_of("b44a", "Z", "depth"), "");
    EXPECT_EQ(warnings_of("pxr24", "mask.V", "mask", PixelType::half), "");
    EXPECT_EQ(warnings_of("dwaa", "id.r", "object_id"), "");
    EXPECT_EQ(warnings_of("zip", "VRayZDepth.R", "depth"), "");
}

}  // namespace
}  // namespace aftershade::test
