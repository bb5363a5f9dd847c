// What outputs say of their colours, and that data is not stored with loss.
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "framework/file/exr_file.h"
#include "tests/cli/command.h"
#include "tests/synthetic_capture.h"
#include "tests/temporary_folder.h"

namespace aftershade::test {
namespace {

namespace fs = std::filesystem;
using Args = std::vector<std::string>;
using Attributes = std::map<std::string, ExrValue>;

void write_colors(const fs::path& path, const Attributes& attributes, const Args& others = {},
                  PixelType type = PixelType::float32) {
    Image image(8, 8, 1);
    for (std::size_t i = 0; i < image.floats().size(); ++i) image.floats()[i] = 0.3f + float(i) / 4096;
    std::vector<ExrOutputChannel> channels;
    for (const char* name : {"R", "G", "B"}) channels.push_back({name, PixelType::float32, &image, 0});
    for (const std::string& name : others) channels.push_back({name, type, &image, 0});
    ExrWriteOptions options;
    options.data_window = options.display_window = {0, 0, 7, 7};
    options.attributes = attributes;
    write_exr(path, channels, options);
}

CommandResult run_on(const TemporaryFolder& folder, Args args) {
    write_text(folder / "look.json", R"({"aftershade": 1, "steps": []})");
    args.insert(args.begin(), {"run", (folder / "look.json").string(), (folder / "in.exr").string()});
    args.insert(args.end(), {"--progress", "none", "--backend", "software"});
    return run_aftershade(args, folder.path());
}

ExrMetadata output_of(const Attributes& attributes, Args args) {
    const TemporaryFolder folder;
    write_colors(folder / "in.exr", attributes);
    args.insert(args.end(), {"-o", (folder / "out.exr").string()});
    const CommandResult result = run_on(folder, args);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return ExrFile(folder / "out.exr").parts()[0].metadata;
}

TEST(OutputColorSpace, IsThatOfThePixels) {
    const ExrMetadata decoded = output_of({{"colorInteropID", "srgb_rec709_scene"}}, {});
    EXPECT_EQ(decoded.text("colorInteropID"), "lin_rec709_scene");
    const ExrMetadata aces = output_of({{"acesImageContainerFlag", 1}}, {});
    EXPECT_EQ(aces.text("colorInteropID"), "lin_ap0_scene");
    EXPECT_FALSE(aces.value("acesImageContainerFlag"));
    EXPECT_EQ(stored_primaries(aces), *color_space_primaries("ap0"));
    const ExrMetadata other =
        output_of({{"oiio:ColorSpace", "sRGB"}, {"colorInteropID", "lin_ap1_scene"}}, {});
    EXPECT_EQ(other.text("colorInteropID"), "lin_ap1_scene");
    EXPECT_FALSE(other.text("oiio:ColorSpace"));
    EXPECT_FALSE(output_of({}, {}).text("colorInteropID")) << "nothing says so";
    EXPECT_EQ(output_of({{"colorInteropID", "studio:x"}}, {}).text("colorInteropID"), "studio:x");
}

TEST(OutputColorSpace, OfKeptChannelsIsTheStoredOne) {
    const ExrMetadata stored = output_of({{"colorInteropID", "srgb_rec709_scene"}}, {"--keep-channels"});
    EXPECT_EQ(stored.text("colorInteropID"), "srgb_rec709_scene");
    const ExrMetadata declared =
        output_of({{"colorInteropID", "lin_rec709_scene"}}, {"--keep-channels", "--color-space", "p3d65"});
    EXPECT_EQ(declared.text("colorInteropID"), "lin_p3d65_scene");
    EXPECT_EQ(stored_primaries(declared), *color_space_primaries("p3d65"));
}

TEST(OutputColorSpace, IsPrintedWithWhatSaysSo) {
    const TemporaryFolder folder;
    write_colors(folder / "in.exr", {{"colorInteropID", "lin_p3d65_scene"}, {"acesImageContainerFlag", 1}});
    const std::string file = (folder / "in.exr").string();
    const CommandResult inspected = run_aftershade({"inspect", file}, folder.path());
    EXPECT_NE(inspected.out.find("color space: p3d65 (colorInteropID)"), std::string::npos) << inspected.out;
    EXPECT_NE(inspected.out.find("warning: colorInteropID is 'lin_p3d65_scene', but acesImageContainerFlag"),
              std::string::npos)
        << inspected.out;
    const auto document =
        nlohmann::json::parse(run_aftershade({"inspect", "--json", file}, folder.path()).out);
    EXPECT_EQ(document.at("color_space").at("name"), "p3d65");
    EXPECT_EQ(document.at("color_space").at("known_by"), "colorInteropID");
    const CommandResult explained = run_on(folder, {"--explain", "-o", (folder / "o.exr").string()});
    EXPECT_NE(explained.out.find("color space: p3d65 (colorInteropID)"), std::string::npos) << explained.err;
    const CommandResult ran = run_on(folder, {"-o", (folder / "o.exr").string()});
    EXPECT_NE(ran.err.find("colorInteropID counts"), std::string::npos) << ran.err;
}

TEST(OutputCompression, OfDataThatItWouldAlterIsRefused) {
    const TemporaryFolder folder;
    write_capture(make_capture({.width = 16, .height = 9}), folder / "in.exr");
    const auto refusal = [&](const char* roles, const char* compression) {
        const CommandResult result = run_on(folder, {"-o", (folder / "out.exr").string(), "--output-roles",
                                                     roles, "--compression", compression});
        return std::to_string(result.exit_code) + result.err;
    };
    const std::string velocity = refusal("color,velocity", "dwaa");
    EXPECT_NE(velocity.find("the compression dwaa loses bits of the channel 'velocity.Y', which holds data"),
              std::string::npos)
        << velocity;
    EXPECT_NE(refusal("color,depth", "pxr24").find("'Z'"), std::string::npos);
    for (const char* compression : {"dwaa", "dwab", "b44"})
        EXPECT_EQ(refusal("color,depth", compression).front(), '0') << compression;
    EXPECT_EQ(refusal("color", "pxr24").front(), '0');
}

TEST(OutputCompression, OfIdsThatItKeepsIsTaken) {
    const TemporaryFolder folder;
    const std::string out = (folder / "out.exr").string();
    SyntheticScene scene{.width = 64, .height = 36};
    scene.box = SyntheticBox{4, 6, 16, 12, 5, 2};
    write_capture(make_capture(scene), folder / "in.exr");
    for (const char* compression : {"dwaa", "dwab", "b44", "b44a", "pxr24"}) {
        const CommandResult result =
            run_on(folder, {"-o", out, "--output-roles", "color,object_id", "--compression", compression});
        EXPECT_EQ(result.exit_code, 0) << compression << result.err;
        const Args names = {"object_id.I"};
        EXPECT_TRUE(std::ranges::equal(ExrFile(out).read_uints(0, names).uints(),
                                       ExrFile(folder / "in.exr").read_uints(0, names).uints()))
            << compression;
    }
    for (const PixelType type : {PixelType::float32, PixelType::half}) {
        write_colors(folder / "in.exr", {}, {"CryptoObject00.X"}, type);
        const CommandResult kept = run_on(folder, {"-o", out, "--keep-channels", "--compression", "b44"});
        const bool is_lost = type == PixelType::half;
        EXPECT_EQ(kept.exit_code, is_lost ? 6 : 0) << kept.err;
        EXPECT_EQ(kept.err.find("loses bits of the channel 'CryptoObject00.X', which holds ids") !=
                      std::string::npos,
                  is_lost)
            << kept.err;
    }
}

TEST(OutputCompression, OfKeptChannelsKeepsThemOrIsRefused) {
    const TemporaryFolder folder;
    write_colors(folder / "in.exr", {}, {"custom.Y", "custom.Q"});
    const std::string out = (folder / "out.exr").string();
    const auto kept = [&](const char* compression) {
        return run_on(folder, {"-o", out, "--keep-channels", "--compression", compression});
    };
    for (const char* compression : {"dwaa", "pxr24"}) {
        const CommandResult result = kept(compression);
        EXPECT_EQ(result.exit_code, 6);
        EXPECT_NE(result.err.find("--keep-channels keeps bit for bit (choose zip"), std::string::npos)
            << result.err;
        EXPECT_FALSE(fs::exists(out));
    }
    EXPECT_EQ(kept("b44").exit_code, 0) << "which stores floats as they are";
    const Args names = {"custom.Y"};
    EXPECT_TRUE(std::ranges::equal(ExrFile(out).read_floats(0, names).floats(),
                                   ExrFile(folder / "in.exr").read_floats(0, names).floats()));
}

}  // namespace
}  // namespace aftershade::test
