#include "framework/compare/layer.h"

#include <OpenEXR/ImfRgbaFile.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <map>

#include "framework/base/error.h"
#include "framework/compare/layer_file.h"
#include "framework/image/role.h"
#include "tests/compare/pictures.h"
#include "tests/real_captures.h"

namespace aftershade {
namespace {

std::vector<LayerInfo> layers(const std::vector<std::string>& floats,
                              const std::vector<std::string>& uints = {}) {
    std::vector<ExrChannel> channels;
    for (const std::string& name : floats) channels.push_back({name, PixelType::half});
    for (const std::string& name : uints) channels.push_back({name, PixelType::uint32});
    std::ranges::sort(channels, {}, &ExrChannel::name);  // as files have them
    const Window window{0, 0, 3, 3};
    return layers_of_channels("", channels, window, window);
}

std::vector<std::string> told(const std::vector<LayerInfo>& layers) {
    std::vector<std::string> texts;
    for (const LayerInfo& layer : layers)
        texts.push_back(layer.label() + " " + std::string(layer_role_name(layer.role)));
    std::ranges::sort(texts);
    return texts;
}

using Texts = std::vector<std::string>;

TEST(Layers, OfTheRootAreColoursAlphaAndDepth) {
    EXPECT_EQ(told(layers({"A", "B", "G", "R", "Z"})), (Texts{"A alpha", "RGB color", "Z depth"}));
    EXPECT_EQ(told(layers({"Y"})), Texts{"Y color"});
    EXPECT_EQ(told(layers({"Y", "A"})), (Texts{"A alpha", "Y color"}));
}

TEST(Layers, AreNamedUpToTheLastDot) {
    EXPECT_EQ(told(layers({"left.diffuse.R", "left.diffuse.G", "left.diffuse.B", "diffuse.R"})),
              (Texts{"diffuse.R color", "left.diffuse.RGB color"}));
}

TEST(Layers, KnowTheRolesOfThisProgramsOwnFiles) {
    EXPECT_EQ(
        told(layers({"velocity.X", "velocity.Y", "velocity_next.X", "velocity_next.Y", "normal.X", "normal.Y",
                     "normal.Z", "mask.V", "display.R", "display.G", "display.B", "display.A", "albedo.R",
                     "albedo.G", "albedo.B"},
                    {"object_id.I"})),
        (Texts{"albedo.RGB color", "display.A alpha", "display.RGB display", "mask.V data", "normal.XYZ data",
               "object_id.I id", "velocity.XY velocity", "velocity_next.XY velocity"}));
}

TEST(Layers, OfEveryRoleAreComparedAsItsKindIs) {
    const std::map<RoleKind, LayerRole> expected = {
        {RoleKind::light, LayerRole::color},     {RoleKind::distance, LayerRole::depth},
        {RoleKind::motion, LayerRole::velocity}, {RoleKind::direction, LayerRole::data},
        {RoleKind::place, LayerRole::data},      {RoleKind::id, LayerRole::id},
        {RoleKind::coverage, LayerRole::data},   {RoleKind::display, LayerRole::display}};
    for (const ChannelRole& role : channel_roles()) {
        std::vector<std::string> floats, uints;
        (role.type == ComponentType::uint32 ? uints : floats) = role.native_channels;
        for (const LayerInfo& layer : layers(floats, uints)) {
            if (layer.role == LayerRole::alpha) continue;
            EXPECT_EQ(layer.role, expected.at(role.kind)) << role.name << ": " << layer.label();
        }
    }
}

TEST(Layers, KnowTheRolesOfBlendersFiles) {
    EXPECT_EQ(
        told(layers({"ViewLayer.Combined.R", "ViewLayer.Combined.G", "ViewLayer.Combined.B",
                     "ViewLayer.Combined.A", "ViewLayer.Depth.Z", "ViewLayer.IndexOB.X", "ViewLayer.Vector.X",
                     "ViewLayer.Vector.Y", "ViewLayer.Vector.Z", "ViewLayer.Vector.W",
                     "ViewLayer.CryptoObject00.r", "ViewLayer.CryptoObject00.g"})),
        (Texts{"ViewLayer.Combined.A alpha", "ViewLayer.Combined.RGB color", "ViewLayer.CryptoObject00.rg id",
               "ViewLayer.Depth.Z depth", "ViewLayer.IndexOB.X id", "ViewLayer.Vector.XYZW velocity"}));
}

TEST(Layers, KnowTheViewOfAPassBeforeOrBehindItsName) {
    EXPECT_EQ(told(layers({"forward.left.u", "forward.left.v", "left.forward.u", "left.forward.v"})),
              (Texts{"forward.left.uv velocity", "left.forward.uv velocity"}));
}

TEST(Layers, OfAViewHaveADepth) {
    EXPECT_EQ(told(layers({"left.R", "left.G", "left.B", "left.Z", "normal.Z"})),
              (Texts{"left.RGB color", "left.Z depth", "normal.Z data"}));
}

TEST(Layers, TakeWhatTheirNamesLackFromTheirPart) {
    const auto of_part = [](const std::string& part, const std::vector<std::string>& names) {
        std::vector<ExrChannel> channels;
        for (const std::string& name : names) channels.push_back({name, PixelType::half});
        return told(layers_of_channels(part, channels, {0, 0, 3, 3}, {0, 0, 3, 3}));
    };
    EXPECT_EQ(of_part("velocity", {"X", "Y"}), Texts{"velocity:XY velocity"});
    EXPECT_EQ(of_part("N", {"X", "Y", "Z"}), Texts{"N:XYZ data"});
    EXPECT_EQ(of_part("N", {"B", "G", "R"}), Texts{"N:RGB data"});
    EXPECT_EQ(of_part("depth", {"Z"}), Texts{"depth:Z depth"});
    EXPECT_EQ(of_part("CryptoObject00", {"B", "G", "R"}), Texts{"CryptoObject00:RGB id"});
    EXPECT_EQ(of_part("rgba", {"A", "B", "G", "R"}), (Texts{"rgba:A alpha", "rgba:RGB color"}));
}

TEST(Layers, TakeColoursOfNormalsForData) {
    EXPECT_EQ(told(layers({"N.R", "N.G", "N.B"})), Texts{"N.RGB data"});
}

TEST(Layers, KeepIntegersApartFromFloats) {
    const std::vector<LayerInfo> found = layers({"thing.R"}, {"thing.I"});
    EXPECT_EQ(told(found), (Texts{"thing.I id", "thing.R color"}));
    EXPECT_NE(found[0].type, found[1].type);
}

TEST(LayerFile, ReadsPngAsEncodedColours) {
    const test::TemporaryFolder folder;
    write_png(folder / "a.png", test::constant(2, 2, {1, 0.2f, 0, 0.6f}));
    const LayerFile file(folder / "a.png");
    EXPECT_EQ(told(file.layers()), (Texts{"A alpha", "RGB display"}));
    EXPECT_EQ(file.read(file.layers()[0], {"G", "R"}).at(1, 1, 0), 0.2f);
}

TEST(LayerFile, ReadsARadiancePicture) {
    // Two pixels of RGBE, not run-length coded: 2^(129 - 136) per count.
    const test::TemporaryFolder folder;
    const std::string header = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 2\n";
    const std::string pixels = {char(128), char(64), char(0), char(129),
                                char(255), char(1),  char(2), char(128)};
    test::write_text(folder / "a.hdr", header + pixels);
    const LayerFile file(folder / "a.hdr");
    ASSERT_EQ(told(file.layers()), Texts{"RGB color"});
    const Image image = file.read(file.layers()[0], {"R", "G", "B"});
    EXPECT_EQ(image.at(0, 0, 0), 1);
    EXPECT_EQ(image.at(0, 0, 1), 0.5f);
    EXPECT_EQ(image.at(1, 0, 0), 255 / 256.0f);
    for (const std::size_t cut : {1u, 4u, 7u}) {
        test::write_text(folder / "b.hdr", header + pixels.substr(0, pixels.size() - cut));
        EXPECT_THROW(LayerFile(folder / "b.hdr"), Error) << cut << " bytes less";
    }
}

TEST(LayerFile, RefusesWhatIsNoPicture) {
    const test::TemporaryFolder folder;
    test::write_text(folder / "a.exr", "This is a text.");
    test::write_text(folder / "empty.png", "");
    EXPECT_THROW(LayerFile(folder / "a.exr"), Error);
    EXPECT_THROW(LayerFile(folder / "empty.png"), Error);
    EXPECT_THROW(LayerFile(folder / "none.exr"), Error);
    EXPECT_THROW(LayerFile(folder.path()), Error);
}

TEST(LayerFile, KnowsTheLayersOfAMultiPartFile) {
    AFTERSHADE_REQUIRE_CAPTURE(path, "beachball/multipart.0001.exr");
    const LayerFile file(*path);
    const Texts texts = told(file.layers());
    for (const char* expected : {"depth_left:Z depth", "forward_left:forward.uv velocity",
                                 "rgba_right:RGB color", "rgba_right:A alpha"})
        EXPECT_NE(std::ranges::find(texts, std::string(expected)), texts.end()) << expected;
    for (const LayerInfo& layer : file.layers()) EXPECT_FALSE(layer.part.empty());
}

TEST(LayerFile, ConvertsSubsampledChroma) {
    const test::TemporaryFolder folder;
    {
        Imf::RgbaOutputFile out((folder / "yc.exr").c_str(), 16, 16, Imf::WRITE_YC);
        const std::vector<Imf::Rgba> pixels(16 * 16, Imf::Rgba(0.5f, 0.25f, 0.125f, 1));
        out.setFrameBuffer(pixels.data(), 1, 16);
        out.writePixels(16);
    }
    const LayerFile file(folder / "yc.exr");
    // What is stored is compared, and its colours: this file stores no alpha.
    EXPECT_EQ(told(file.layers()), (Texts{"BY data", "RGB color", "RY data", "Y data"}));
    const auto colors = std::ranges::find(file.layers(), LayerRole::color, &LayerInfo::role);
    const Image image = file.read(*colors, {"R", "G", "B"});
    EXPECT_NEAR(image.at(8, 8, 0), 0.5f, 0.01f);
    EXPECT_NEAR(image.at(8, 8, 2), 0.125f, 0.01f);
}

}  // namespace
}  // namespace aftershade
