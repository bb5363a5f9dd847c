// Captures through the command: what is kept, cropped, missing, audited, checked.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <set>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "framework/file/exr_file.h"
#include "framework/file/png_file.h"
#include "framework/image/color_space.h"
#include "tests/cli/command.h"
#include "tests/real_captures.h"
#include "tests/synthetic_capture.h"
#include "tests/temporary_folder.h"

namespace aftershade::test {
namespace {

namespace fs = std::filesystem;
using Args = std::vector<std::string>;

const std::string kEmptyLook = R"({"aftershade": 1, "steps": []})";
const std::string kExposureLook = R"({"aftershade": 1, "steps": [{"effect": "brighten"}]})";
const fs::path kSuzanne = AFTERSHADE_SOURCE_DIR "/scenes/suzanne/gbuffer_0004.exr";

/// An effect of the test's own that doubles the light, so that one role changes.
void write_brighten(const TemporaryFolder& folder) {
    fs::create_directories(folder / "effects/brighten");
    write_text(folder / "effects/brighten/effect.json",
               R"({"aftershade": 1, "id": "brighten", "version": "1.0.0", "summary": "x",
        "inputs": {"color": {"role": "color"}, "depth": {"role": "depth"}},
        "outputs": {"color": {"role": "color"}, "depth": {"role": "depth"}},
        "passes": [{"name": "go", "shader": "go.frag", "reads": ["color", "depth"], "writes": ["color", "depth"]}]})");
    write_text(folder / "effects/brighten/go.frag", R"(#version 450 core
#include <pass>
void main() {
    out_color = vec4(2.0, 2.0, 2.0, 1.0) * texelFetch(color, ivec2(gl_FragCoord.xy), 0);
    out_depth = 0.5 * texelFetch(depth, ivec2(gl_FragCoord.xy), 0).r;
})");
}

/// Runs in `folder`, with the look written there and progress off.
CommandResult run(const TemporaryFolder& folder, const std::string& look, Args args) {
    write_text(folder / "look.json", look);
    args.insert(args.begin(), {"run", (folder / "look.json").string()});
    args.insert(args.end(), {"--progress", "none", "--backend", "software"});
    return run_aftershade(args, folder.path());
}

bool same_bits(const Image& a, const Image& b) {
    return a.type() == b.type() && a.width() == b.width() &&
           (a.type() == ComponentType::uint32
                ? std::ranges::equal(a.uints(), b.uints())
                : std::memcmp(a.floats().data(), b.floats().data(), a.floats().size_bytes()) == 0);
}

void expect_same_channels(const ExrFile& before, const ExrFile& after, const std::set<std::string>& changed) {
    ASSERT_EQ(before.parts()[0].channels.size(), after.parts()[0].channels.size());
    for (const ExrChannel& channel : before.parts()[0].channels) {
        const Args name{channel.name};
        const bool same = same_bits(before.read_floats(0, name), after.read_floats(0, name));
        EXPECT_EQ(same, !changed.contains(channel.name)) << channel.name;
    }
}

TEST(KeepChannels, ThroughAnEmptyLookKeepsEveryBitAndEveryAttribute) {
    const TemporaryFolder folder;
    const CommandResult result =
        run(folder, kEmptyLook, {kSuzanne.string(), "-o", (folder / "out.exr").string(), "--keep-channels"});
    ASSERT_EQ(result.exit_code, 0) << result.err;
    const ExrFile before(kSuzanne), after(folder / "out.exr");
    expect_same_channels(before, after, {});
    for (std::size_t i = 0; i < before.parts()[0].channels.size(); ++i)
        EXPECT_EQ(before.parts()[0].channels[i].type, after.parts()[0].channels[i].type);
    const ExrMetadata& old_metadata = before.parts()[0].metadata;
    const ExrMetadata& new_metadata = after.parts()[0].metadata;
    for (const std::string& name : old_metadata.names())
        EXPECT_EQ(old_metadata.value(name), new_metadata.value(name)) << name;
    for (const std::string& name : new_metadata.names()) {
        const bool is_new = new_metadata.value(name) && !old_metadata.value(name);
        EXPECT_TRUE(!is_new || name.starts_with("aftershade/")) << name;
    }
}

TEST(KeepChannels, ReencodesTheRolesThatAStepChanged) {
    const TemporaryFolder folder;
    write_brighten(folder);
    const CommandResult result = run(folder, kExposureLook,
                                     {kSuzanne.string(), "-o", (folder / "out.exr").string(),
                                      "--keep-channels", "--effect-path", (folder / "effects").string()});
    ASSERT_EQ(result.exit_code, 0) << result.err;
    const ExrFile before(kSuzanne), after(folder / "out.exr");
    const std::string layer = "ViewLayer.";
    expect_same_channels(
        before, after, {layer + "Combined.R", layer + "Combined.G", layer + "Combined.B", layer + "Depth.Z"});
    const Args depth{layer + "Depth.Z"}, red{layer + "Combined.R"};
    const Image z = before.read_floats(0, depth), halved = after.read_floats(0, depth);
    const Image light = before.read_floats(0, red), doubled = after.read_floats(0, red);
    for (std::size_t i = 0; i < z.floats().size(); ++i) {
        // 1e10 is Blender's mark for nothing hit, and stays it.
        ASSERT_EQ(halved.floats()[i], z.floats()[i] >= 1e10f ? 1e10f : z.floats()[i] / 2) << i;
        ASSERT_EQ(doubled.floats()[i], 2 * light.floats()[i]) << i;
    }
}

TEST(KeepChannels, WritesARoleFromAFileOfItsOwnAsTheStepsMadeIt) {
    const TemporaryFolder folder;
    write_brighten(folder);
    write_capture(make_capture({.width = 8, .height = 8, .background = {9, 9, 9}, .background_depth_m = 4}),
                  folder / "main.0001.exr");
    write_capture(make_capture({.width = 8, .height = 8, .background = {1, 1, 1}}),
                  folder / "color.0001.exr");
    const CommandResult result =
        run(folder, kExposureLook,
            {(folder / "main.0001.exr").string(), "--role", "color=" + (folder / "color.0001.exr").string(),
             "--keep-channels", "-o", (folder / "out.exr").string(), "--effect-path",
             (folder / "effects").string()});
    ASSERT_EQ(result.exit_code, 0) << result.err;
    const ExrFile out(folder / "out.exr");
    EXPECT_EQ(out.read_floats(0, Args{"R"}).at(3, 3, 0), 2);
    EXPECT_EQ(out.read_floats(0, Args{"Z"}).at(3, 3, 0), 2);
}

TEST(Output, NeverReplacesTheFileOfARole) {
    const TemporaryFolder folder;
    for (const char* name : {"main.0001.exr", "z.0001.exr"})
        write_capture(make_capture({.width = 8, .height = 8}), folder / name);
    const std::string before = read_text(folder / "z.0001.exr");
    const CommandResult result =
        run(folder, kEmptyLook,
            {(folder / "main.0001.exr").string(), "--role", "depth=" + (folder / "z.0001.exr").string(), "-o",
             (folder / "z.0001.exr").string()});
    EXPECT_EQ(result.exit_code, 2) << result.err;
    EXPECT_EQ(read_text(folder / "z.0001.exr"), before);
}

TEST(Output, CropsToTheDisplayWindow) {
    const TemporaryFolder folder;
    Image image(8, 6, 3);
    for (int y = 0; y < 6; ++y)
        for (int x = 0; x < 8; ++x) image.at(x, y, 0) = float(10 * y + x);
    std::vector<ExrOutputChannel> channels;
    for (int c = 0; c < 3; ++c) channels.push_back({std::string(1, "RGB"[c]), PixelType::float32, &image, c});
    channels.push_back({"Z", PixelType::float32, &image, 0});
    ExrWriteOptions options;
    options.data_window = {-2, -1, 5, 4};
    options.display_window = {0, 0, 6, 3};
    write_exr(folder / "in.exr", channels, options);
    ASSERT_EQ(run(folder, kEmptyLook,
                  {(folder / "in.exr").string(), "-o", (folder / "out.exr").string(), "--crop", "display",
                   "--output-roles", "color,depth"})
                  .exit_code,
              0);
    const ExrFile cropped(folder / "out.exr");
    EXPECT_EQ(cropped.parts()[0].data_window, options.display_window);
    const Image red = cropped.read_floats(0, Args{"R"});
    EXPECT_EQ(red.at(0, 0, 0), 12);  // display (0, 0) is row 1, column 2 of the data
    EXPECT_EQ(red.at(5, 3, 0), 47);
    EXPECT_EQ(red.at(6, 3, 0), 0);  // beyond the data
    EXPECT_TRUE(std::isinf(cropped.read_floats(0, Args{"Z"}).at(6, 3, 0))) << "nothing is hit there";
}

TEST(Output, CarriesTheCameraOfCaptureJson) {
    const TemporaryFolder folder;
    write_capture(make_capture({.width = 16, .height = 9}), folder / "in_0001.exr");
    write_text(folder / "capture.json", R"({"aftershade": 1, "frames": "in_####.exr",
        "camera": {"focal_length": "85 mm", "focus_distance": "120 cm", "lens_model": "pinhole"}})");
    ASSERT_EQ(run(folder, kEmptyLook,
                  {(folder / "capture.json").string(), "-o", (folder / "out_####.exr").string()})
                  .exit_code,
              0);
    const ExrFile file(folder / "out_0001.exr");
    EXPECT_EQ(file.parts()[0].metadata.number("aftershade/camera/focal_length"), 85);
    EXPECT_FLOAT_EQ(float(*file.parts()[0].metadata.number("aftershade/camera/focus_distance")), 1.2f);
    // And another run finds it there.
    const CommandResult inspected =
        run_aftershade({"inspect", "--json", (folder / "out_0001.exr").string()}, folder.path());
    EXPECT_EQ(nlohmann::json::parse(inspected.out).at("camera").at("focal_length"), 85) << inspected.out;
}

TEST(Output, OfColoursInOtherPrimariesSaysSoAndShowsThemRight) {
    const TemporaryFolder folder;
    const Rgb acescg{0.4f, 0.2f, 0.1f};
    write_capture(make_capture({.width = 8, .height = 8, .background = acescg}), folder / "in.0001.exr");
    write_text(folder / "capture.json",
               R"({"aftershade": 1, "frames": "in.####.exr", "color_space": "acescg"})");
    const std::string view = R"({"aftershade": 1, "steps": [{"effect": "view_transform"}]})";
    for (const auto& [look, png] : {std::pair(view, "view.png"), std::pair(kEmptyLook, "color.png")})
        ASSERT_EQ(run(folder, look,
                      {(folder / "capture.json").string(), "-o", (folder / png).string(), "-o",
                       (folder / "out.exr").string()})
                      .exit_code,
                  0);
    const Chromaticities ap1 = *color_space_primaries("acescg");
    EXPECT_EQ(stored_primaries(ExrFile(folder / "out.exr").parts()[0].metadata), ap1);
    const ColorMatrix m = conversion_matrix(ap1, kRec709);
    for (const char* png : {"view.png", "color.png"}) {
        const Image picture = read_png(folder / png);
        for (std::size_t c = 0; c < 3; ++c) {
            const double linear = m[c * 3] * acescg.r + m[c * 3 + 1] * acescg.g + m[c * 3 + 2] * acescg.b;
            EXPECT_NEAR(picture.at(3, 3, int(c)), 1.055 * std::pow(linear, 1 / 2.4) - 0.055, 0.51 / 255)
                << png << c;
        }
    }
}

TEST(Overscan, IsSeenByEffectsBeyondTheDisplayWindow) {
    const TemporaryFolder folder;
    // A light four pixels left of the display window, far out of focus.
    Capture capture = make_capture({.width = 64, .height = 32, .points = {{12, 16, 1000}}});
    capture.header.display_window = {16, 0, 63, 31};
    write_capture(capture, folder / "in.exr");
    const std::string look =
        R"({"aftershade": 1, "steps": [{"effect": "bokeh", "params": {"focus_distance": 2,
        "focal_length": 200, "f_number": 1, "lens_model": "pinhole"}}]})";
    ASSERT_EQ(run(folder, look,
                  {(folder / "in.exr").string(), "-o", (folder / "out.exr").string(), "--crop", "display",
                   "--pixel-type", "float"})
                  .exit_code,
              0);
    EXPECT_GT(ExrFile(folder / "out.exr").read_floats(0, Args{"R"}).at(1, 16, 0), 0.5f);
}

TEST(Explain, NamesWhereEachValueIsFrom) {
    const TemporaryFolder folder;
    write_capture(make_capture({.width = 16, .height = 9}), folder / "in_0001.exr");
    write_text(folder / "capture.json",
               R"({"aftershade": 1, "frames": "in_####.exr", "camera": {"focal_length": "85 mm"}})");
    const std::string look = R"({"aftershade": 1, "steps": [{"effect": "bokeh", "preset": "fast",
        "params": {"f_number": 2}}]})";
    const CommandResult result = run(folder, look,
                                     {(folder / "capture.json").string(), "-o", (folder / "o_#.exr").string(),
                                      "--explain", "--set", "bokeh.shape=octagon"});
    ASSERT_EQ(result.exit_code, 0) << result.err;
    for (const std::string line :
         {"bokeh.f_number = 2   [the look]", "bokeh.taps = 17   [preset fast]",
          "bokeh.focal_length = 85 mm   [capture.json]", "bokeh.shape = \"octagon\"   [--set]",
          "bokeh.focus_distance = 3 m   [the manifest]"})
        EXPECT_NE(result.out.find(line + "\n"), std::string::npos) << line << "\n" << result.out;
    EXPECT_FALSE(fs::exists(folder / "o_1.exr"));
}

/// Frames 1 and 3 of a sequence that declares 1 to 3.
Args gappy_sequence(const TemporaryFolder& folder, const std::string& missing) {
    for (const int frame : {1, 3})
        write_capture(
            make_capture({.width = 16, .height = 9, .background = {0.1f * float(frame), 0, 0}}, frame),
            folder / ("in_000" + std::to_string(frame) + ".exr"));
    write_text(folder / "capture.json", R"({"aftershade": 1, "frames": "in_####.exr", "range": "1-3"})");
    return {(folder / "capture.json").string(), "-o", (folder / "out_####.exr").string(), "--missing",
            missing};
}

float red_of(const fs::path& file) {
    return ExrFile(file).read_floats(0, Args{"R"}).at(0, 0, 0);
}

/// Engines' buffers: light, and an alpha that nobody wrote.
TEST(Alpha, ThatIsZeroEverywhereIsSaidAndCanBeReadAsOne) {
    const TemporaryFolder folder;
    Image color(4, 4, 4);
    for (std::size_t i = 0; i < color.floats().size(); ++i) color.floats()[i] = i % 4 == 3 ? 0.0f : 0.5f;
    std::vector<ExrOutputChannel> channels;
    for (int c = 0; c < 4; ++c) channels.push_back({std::string(1, "RGBA"[c]), PixelType::half, &color, c});
    ExrWriteOptions options;
    options.data_window = options.display_window = {0, 0, 3, 3};
    write_exr(folder / "a.exr", channels, options);
    const auto alpha_of = [&](Args more) {
        Args args{"run",
                  (folder / "look.json").string(),
                  (folder / "a.exr").string(),
                  "-o",
                  (folder / "out.png").string(),
                  "--progress",
                  "plain",
                  "--backend",
                  "software"};
        args.insert(args.end(), more.begin(), more.end());
        write_text(folder / "look.json", kEmptyLook);
        const CommandResult result = run_aftershade(args, folder.path());
        EXPECT_EQ(result.exit_code, 0) << result.err;
        const bool is_said = result.err.find("alpha of color is 0 everywhere") != std::string::npos;
        const Image png = read_png(folder / "out.png");
        return std::pair(png.channels() == 4 ? png.at(1, 1, 3) : 1.0f, is_said);
    };
    EXPECT_EQ(alpha_of({}), std::pair(0.0f, true));
    EXPECT_EQ(alpha_of({"--alpha", "opaque"}), std::pair(1.0f, false));
    EXPECT_EQ(alpha_of({"--alpha", "keep"}), std::pair(0.0f, true));
}

TEST(MissingFrame, IsAFailureUnlessSkippedOrHeld) {
    const TemporaryFolder failed, skipped, held;
    EXPECT_EQ(run(failed, kEmptyLook, gappy_sequence(failed, "error")).exit_code, 1);
    EXPECT_TRUE(fs::exists(failed / "out_0003.exr"));
    EXPECT_EQ(run(skipped, kEmptyLook, gappy_sequence(skipped, "skip")).exit_code, 0);
    EXPECT_FALSE(fs::exists(skipped / "out_0002.exr"));
    EXPECT_EQ(run(held, kEmptyLook, gappy_sequence(held, "hold")).exit_code, 0);
    EXPECT_EQ(red_of(held / "out_0002.exr"), red_of(held / "out_0001.exr"));
    EXPECT_NE(red_of(held / "out_0003.exr"), red_of(held / "out_0001.exr"));
}

TEST(Capture, MayBeAFolderOrHaveItsDepthInFilesOfItsOwn) {
    const TemporaryFolder folder;
    write_brighten(folder);
    const Capture whole =
        make_capture({.width = 16, .height = 9, .background = {1, 1, 1}, .background_depth_m = 8});
    std::vector<ExrOutputChannel> color, depth{{"Z", PixelType::float32, &whole.images.at("depth"), 0}};
    for (int c = 0; c < 3; ++c)
        color.push_back({std::string(1, "RGB"[c]), PixelType::half, &whole.images.at("color"), c});
    ExrWriteOptions options;
    options.data_window = options.display_window = {0, 0, 15, 8};
    fs::create_directories(folder / "beauty");
    write_exr(folder / "beauty/rgb.0001.exr", color, options);
    write_exr(folder / "z.0001.exr", depth, options);
    const Args common = {(folder / "beauty").string(),
                         "-o",
                         (folder / "out_####.exr").string(),
                         "--output-roles",
                         "color,depth",
                         "--effect-path",
                         (folder / "effects").string()};
    EXPECT_EQ(run(folder, kExposureLook, common).exit_code, 3);
    Args with_depth = common;
    with_depth.insert(with_depth.end(), {"--role", "depth=" + (folder / "z.####.exr").string()});
    const CommandResult result = run(folder, kExposureLook, with_depth);
    ASSERT_EQ(result.exit_code, 0) << result.err;
    EXPECT_EQ(ExrFile(folder / "out_0001.exr").read_floats(0, Args{"Z"}).at(3, 3, 0), 4);
}

TEST(Audit, NamesThePassThePixelAndTheCount) {
    const TemporaryFolder folder;
    write_brighten(folder);
    Capture capture = make_capture({.width = 16, .height = 9, .background = {1, 1, 1}});
    capture.images["color"].at(5, 2, 1) = std::numeric_limits<float>::quiet_NaN();
    capture.images["color"].at(7, 2, 0) = std::numeric_limits<float>::infinity();
    write_capture(capture, folder / "in_0001.exr");
    const CommandResult result = run(folder, kExposureLook,
                                     {(folder / "in_0001.exr").string(), "-o", (folder / "o.exr").string(),
                                      "--audit", "--effect-path", (folder / "effects").string()});
    EXPECT_EQ(result.exit_code, 0);
    const std::string expected = " has 1 NaN and 1 infinite values, the first at (5, 2)";
    EXPECT_NE(result.err.find("capture: capture.color" + expected), std::string::npos) << result.err;
    EXPECT_NE(result.err.find("brighten.go: brighten.color" + expected), std::string::npos) << result.err;
    EXPECT_EQ(result.err.find("depth has"), std::string::npos) << "an infinite depth is nothing hit";
}

// ---- inspect --check-velocity ----

/// The blender profile with its velocity read another way, under the same id.
void write_wrong_profile(const TemporaryFolder& folder, const std::string& velocity) {
    write_text(folder / "blender.json", R"({"aftershade": 1, "id": "blender", "summary": "wrong on purpose",
        "detect": {"attributes": ["BlenderMultiChannel"]},
        "roles": {"color": {"channels": ["{layer}.Combined.R", "{layer}.Combined.G", "{layer}.Combined.B", "{layer}.Combined.A?"]},
                  "velocity": )" + velocity +
                                            "}}");
}

struct WrongSetting {
    const char* velocity;
    const char* remedy;
};

TEST(CheckVelocity, AcceptsTheBlenderProfileAndNamesWhatIsWrongWithAnother) {
    AFTERSHADE_REQUIRE_CAPTURE(suzanne, "suzanne/large");
    const Args check = {"inspect", "--check-velocity", (*suzanne / "gbuffer_0003.exr").string(),
                        (*suzanne / "gbuffer_0004.exr").string()};
    const CommandResult right = run_aftershade(check, *suzanne);
    EXPECT_EQ(right.exit_code, 0) << right.out;

    const WrongSetting kWrong[] = {
        {R"({"channels": ["{layer}.Vector.X", "{layer}.Vector.Y"], "delta": "cur-prev", "y_axis": "up"})",
         "prev-cur"},
        {R"({"channels": ["{layer}.Vector.X", "{layer}.Vector.Y"], "delta": "prev-cur", "y_axis": "down"})",
         "y_axis"},
        {R"({"channels": ["{layer}.Vector.X", "{layer}.Vector.Y"], "delta": "prev-cur", "y_axis": "up", "scale": 2})",
         "scale"},
        {R"({"channels": ["{layer}.Vector.Y", "{layer}.Vector.X"], "delta": "prev-cur", "y_axis": "up"})",
         "order"},
    };
    for (const WrongSetting& wrong : kWrong) {
        const TemporaryFolder folder;
        write_wrong_profile(folder, wrong.velocity);
        Args args = check;
        args.insert(args.end(), {"--profile-path", folder.path().string()});
        const CommandResult result = run_aftershade(args, folder.path());
        EXPECT_EQ(result.exit_code, 1) << wrong.velocity;
        const std::string sentence = result.out.substr(0, result.out.find('\n'));
        EXPECT_NE(sentence.find(wrong.remedy), std::string::npos) << wrong.velocity << "\n" << sentence;
    }
}

TEST(CheckVelocity, FindsThatNoSettingFitsBeachball) {
    AFTERSHADE_REQUIRE_CAPTURE(beachball, "beachball");
    const CommandResult result =
        run_aftershade({"inspect", "--json", "--check-velocity", (*beachball / "multipart.0003.exr").string(),
                        (*beachball / "multipart.0004.exr").string()},
                       *beachball);
    EXPECT_EQ(result.exit_code, 1);
    const auto check = nlohmann::json::parse(result.out).at("checks").at(0);
    EXPECT_EQ(check.at("verdict"), "no_fit");
    EXPECT_EQ(check.at("suggested").at("delta"), "next-cur");
    EXPECT_EQ(check.at("suggested").at("y_axis"), "down");
    // By hand the outline moves (105.2, -22.5) px where forward says (42.0, -18.0): 2.50 and 1.25. The
    // pattern on the ball, which turns, moves (112, -25.5), and the warp sees the pattern.
    EXPECT_NEAR(std::abs(check.at("free_scale").at("x").get<double>()), 2.625, 0.125);
    EXPECT_NEAR(std::abs(check.at("free_scale").at("y").get<double>()), 1.35, 0.15);
}

}  // namespace
}  // namespace aftershade::test
