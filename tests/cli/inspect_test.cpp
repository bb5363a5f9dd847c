#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <limits>
#include <nlohmann/json.hpp>
#include <set>
#include <tuple>

#include "framework/batch/process_codes.h"
#include "framework/file/png_file.h"
#include "framework/inspect/contact_sheet.h"
#include "tests/cli/command.h"
#include "tests/real_captures.h"
#include "tests/synthetic_capture.h"

namespace aftershade::test {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

const std::string kSuzanneCapture = AFTERSHADE_SOURCE_DIR "/scenes/suzanne/capture.json";

std::set<std::string> keys_of(const Json& object) {
    std::set<std::string> keys;
    for (const auto& [key, value] : object.items()) keys.insert(key);
    return keys;
}

const Json& channel_named(const Json& part, const std::string& name) {
    for (const Json& channel : part["channels"])
        if (channel["name"] == name) return channel;
    ADD_FAILURE() << "no channel " << name;
    static const Json none;
    return none;
}

class Inspect : public testing::Test {
protected:
    CommandResult inspect(std::vector<std::string> arguments, ExitCode expected = ExitCode::done,
                          const Environment& environment = {}) {
        arguments.insert(arguments.begin(), "inspect");
        CommandResult result = run_aftershade(arguments, folder_.path(), environment);
        EXPECT_EQ(result.exit_code, int(expected)) << arguments[1] << ": " << result.err;
        return result;
    }
    Json json(std::vector<std::string> arguments, ExitCode expected = ExitCode::done) {
        arguments.push_back("--json");
        return Json::parse(inspect(arguments, expected).out);
    }
    /// One float channel each, 64 x 4 px.
    fs::path write_channels(const std::string& name, const std::vector<std::string>& channels,
                            float value = 1) {
        Image image(64, 4, 1);
        std::fill(image.floats().begin(), image.floats().end(), value);
        std::vector<ExrOutputChannel> outputs;
        for (const std::string& channel : channels)
            outputs.push_back({channel, PixelType::float32, &image, 0});
        ExrWriteOptions options;
        options.data_window = options.display_window = {0, 0, 63, 3};
        write_exr(folder_ / name, outputs, options);
        return folder_ / name;
    }
    TemporaryFolder folder_;
};

TEST_F(Inspect, TellsTheSuzanneCaptureAsJson) {
    const Json document = json({kSuzanneCapture});
    EXPECT_EQ(keys_of(document),
              (std::set<std::string>{"file", "parts", "pixel", "profile", "layer", "layers", "layer_count",
                                     "color_space", "notes", "warnings", "roles", "depth_kind", "missing",
                                     "remedies", "camera", "lights", "cryptomattes"}));
    EXPECT_TRUE(document["file"].get<std::string>().ends_with("scenes/suzanne/gbuffer_0003.exr"));
    ASSERT_EQ(document["parts"].size(), 1);
    const Json& part = document["parts"][0];
    EXPECT_EQ(keys_of(part), (std::set<std::string>{"name", "view", "data_window", "display_window",
                                                    "compression", "channels"}));
    EXPECT_EQ(part["data_window"], Json::parse(R"({"min": [0, 0], "max": [479, 269]})"));
    EXPECT_EQ(part["compression"], "zip");
    ASSERT_EQ(part["channels"].size(), 25);
    for (const Json& channel : part["channels"])
        EXPECT_EQ(keys_of(channel),
                  (std::set<std::string>{"name", "type", "min", "max", "nan", "inf", "negative"}));
    // As oiiotool --stats says.
    EXPECT_EQ(channel_named(part, "ViewLayer.IndexOB.X")["max"], 30);
    EXPECT_EQ(channel_named(part, "ViewLayer.Depth.Z")["max"], 1e10);
    EXPECT_EQ(channel_named(part, "ViewLayer.Depth.Z")["type"], "float");
    EXPECT_EQ(channel_named(part, "ViewLayer.Combined.R")["type"], "half");
    EXPECT_EQ(channel_named(part, "ViewLayer.Combined.R")["max"], 60.28125);
    EXPECT_EQ(channel_named(part, "ViewLayer.Combined.R")["nan"], 0);
    EXPECT_EQ(document["profile"], Json::parse(R"({"id": "blender", "reason": "chosen by name"})"));
    EXPECT_EQ(document["roles"]["depth"], Json::parse(R"(["ViewLayer.Depth.Z"])"));
    EXPECT_EQ(document["missing"], Json::parse(R"(["specular", "emission", "mask"])"));
    EXPECT_EQ(document["camera"]["focal_length"], 50);
    EXPECT_EQ(keys_of(document["remedies"]), (std::set<std::string>{"emission"}));
    EXPECT_NE(document["remedies"]["emission"].get<std::string>().find("Emission ticked"), std::string::npos);
}

TEST_F(Inspect, TellsAPersonTheSame) {
    const CommandResult result = inspect({kSuzanneCapture, "--frames", "4", "--channels"});
    for (const char* words :
         {"scenes/suzanne/gbuffer_0004.exr\n", "part 0: scanlineimage, zip\n",
          "data window     (0, 0)-(479, 269), 480 x 270 px\n", "ViewLayer.IndexOB.X   float  1 x 1 ",
          "profile: blender (chosen by name)\n", "  depth           ViewLayer.Depth.Z\n",
          "(missing)       specular, emission, mask\n", "  focal_length    50 mm\n"})
        EXPECT_NE(result.out.find(words), std::string::npos) << words << "\n" << result.out;
    EXPECT_EQ(result.err, "");
}

TEST_F(Inspect, ListsTheChannelsOnlyOnRequest) {
    const std::string text = inspect({kSuzanneCapture, "--frames", "4"}).out;
    EXPECT_LE(std::ranges::count(text, '\n'), 40) << text;
    EXPECT_NE(text.find("1 part: scanlineimage, zip, 480 x 270 px; "), std::string::npos) << text;
    EXPECT_EQ(text.find("ViewLayer.IndexOB.X   float"), std::string::npos) << text;
}

TEST_F(Inspect, CountsWhatIsNotFinite) {
    Capture capture = make_capture({.width = 8, .height = 4, .background = {0.5f, 0.5f, 0.5f}});
    capture.images["color"].at(1, 2, 0) = std::numeric_limits<float>::quiet_NaN();
    capture.images["color"].at(3, 2, 0) = -1;
    write_capture(capture, folder_ / "a.exr");
    const Json document = json({"a.exr"});
    const Json& red = channel_named(document["parts"][0], "R");
    EXPECT_EQ(red["nan"], 1);
    EXPECT_EQ(red["negative"], 1);
    EXPECT_EQ(red["min"], -1);
    const Json& depth = channel_named(document["parts"][0], "Z");
    EXPECT_EQ(depth["inf"], 32);
    EXPECT_TRUE(depth["min"].is_null());
    EXPECT_TRUE(depth["max"].is_null());
    EXPECT_EQ(channel_named(document["parts"][0], "object_id.I")["type"], "uint");
    EXPECT_EQ(document["profile"]["id"], "native");
}

TEST_F(Inspect, NeedsNoProfileAndNoGl) {
    write_channels("a.exr", {"foo.\xff", "bar"});
    const Json document =
        Json::parse(inspect({"a.exr", "--json"}, ExitCode::done, without_gl(folder_ / "no_gl")).out);
    EXPECT_TRUE(document["profile"]["id"].is_null());
    const std::string reason = document["profile"]["reason"];
    EXPECT_TRUE(reason.starts_with("no profile fits its channels, 'bar' and 'foo.?' (name one with"))
        << reason;
    EXPECT_EQ(document["roles"], Json::object());
    EXPECT_EQ(document["parts"][0]["channels"].size(), 2);
    EXPECT_EQ(document["missing"].size(), 12);
}

TEST_F(Inspect, ShowsNamesFromTheFileWithoutControlCharacters) {
    write_channels("a.exr", {"R\x1b[31m"});
    EXPECT_EQ(inspect({"a.exr"}).out.find('\x1b'), std::string::npos);
}

TEST_F(Inspect, ListsWhatAFileWithDamagedPixelsStillTells) {
    std::string bytes = read_text(write_channels("a.exr", {"R", "G", "B"}, 0.3f));
    write_text(folder_ / "cut.exr", bytes.substr(0, bytes.size() - 10));
    const CommandResult result = inspect({"cut.exr", "--json"}, ExitCode::capture);
    EXPECT_TRUE(result.err.starts_with("aftershade: error: cut.exr: cut off or damaged")) << result.err;
    const Json document = Json::parse(result.out);
    EXPECT_TRUE(channel_named(document["parts"][0], "R")["reason"].get<std::string>().starts_with("cut off"));
    EXPECT_TRUE(channel_named(document["parts"][0], "R")["min"].is_null());
    EXPECT_EQ(document["profile"]["id"], "native");

    write_text(folder_ / "none.exr", "# no picture");
    EXPECT_EQ(inspect({"none.exr"}, ExitCode::capture).out, "");
    inspect({"absent.exr"}, ExitCode::capture);
    inspect({"a.exr", "--max-size", "32"}, ExitCode::capture);
}

TEST_F(Inspect, RefusesWrongWords) {
    write_channels("a.exr", {"R", "G", "B"});
    const auto told = [&](std::vector<std::string> arguments) {
        return inspect(std::move(arguments), ExitCode::usage).err;
    };
    EXPECT_NE(told({"a.exr", "--profile", "blendr"}).find("did you mean 'blender'?"), std::string::npos);
    EXPECT_NE(told({kSuzanneCapture, "--frames", "9"}).find("the capture has no frame 9"), std::string::npos);
    EXPECT_NE(told({kSuzanneCapture, "--frames", "3-4"}).find("inspect shows one"), std::string::npos);
    EXPECT_NE(told({"a.exr", "--contact-sheet", "a.exr"}).find("a contact sheet is a .png file"),
              std::string::npos);
}

TEST_F(Inspect, FailsWhereALayerAViewOrARoleThatWasAskedForIsNotThere) {
    const std::string file =
        write_channels("f.exr", {"R", "G", "B", "diffuse.R", "diffuse.G", "diffuse.B"}).string();
    for (const auto& [words, code, told] :
         {std::tuple{std::vector<std::string>{"--layer", "beauty"}, ExitCode::usage,
                     "has no layer 'beauty' (it has 'diffuse')"},
          {{"--view", "left"}, ExitCode::capture, "has no view 'left'"},
          {{"--role", "depth=" + file}, ExitCode::capture, "which channel is depth is not known"}}) {
        std::vector<std::string> arguments = {file};
        arguments.insert(arguments.end(), words.begin(), words.end());
        const CommandResult result = inspect(arguments, code);
        EXPECT_NE(result.err.find("f.exr: " + std::string(told)), std::string::npos) << result.err;
        EXPECT_NE(result.out.find("diffuse.R"), std::string::npos) << "the channels are listed all the same";
    }
    EXPECT_EQ(json({kSuzanneCapture, "--layer", "Nowhere"}, ExitCode::usage)["profile"]["id"], nullptr);
}

TEST_F(Inspect, PutsEveryRoleOnAContactSheet) {
    SyntheticScene scene{
        .width = 64, .height = 36, .background = {0.1f, 0.2f, 0.4f}, .background_depth_m = 8};
    scene.box = SyntheticBox{4, 6, 16, 12, 5, 2};
    write_capture(make_capture(scene), folder_ / "a.exr");
    const CommandResult result = inspect({"a.exr", "--contact-sheet", "sheet.png", "--json"});
    EXPECT_EQ(Json::parse(result.out)["roles"].size(), 12);
    EXPECT_EQ(result.err, "contact sheet: sheet.png\n");
    const Image sheet = read_png(folder_ / "sheet.png");
    EXPECT_EQ(sheet.channels(), 3);
    EXPECT_GT(sheet.width(), 3 * 448);

    const Json nothing =
        json({write_channels("b.exr", {"foo"}).string(), "--contact-sheet", "b.png"}, ExitCode::capture);
    EXPECT_TRUE(nothing["profile"]["id"].is_null());
    EXPECT_FALSE(fs::exists(folder_ / "b.png"));
    inspect({"a.exr", "--contact-sheet", "no/such/folder.png"}, ExitCode::output);
}

TEST_F(Inspect, PutsTheFramesOfASequenceOnAContactSheet) {
    for (int frame = 1; frame <= 3; ++frame) {
        const std::string number = std::to_string(frame);
        SyntheticScene scene{.width = 96, .height = 54, .background = {0.2f * float(frame), 0.2f, 0.4f}};
        write_capture(make_capture(scene, frame), folder_ / ("in_" + number + ".exr"));
        Image picture(96, 54, 1);
        std::fill(picture.floats().begin(), picture.floats().end(), 0.2f * float(frame));
        write_png(folder_ / ("p_" + number + ".png"), picture);
    }
    const CommandResult result =
        inspect({"in_#.exr", "--frames", "1-3", "--contact-sheet", "sheet.png", "--columns", "2"});
    EXPECT_EQ(result.out, "");
    EXPECT_EQ(result.err, "contact sheet: sheet.png\n");
    const Image sheet = read_png(folder_ / "sheet.png");
    const FrameSheet layout("", 3, 2, 96, 54);
    for (int i = 0; i < 3; ++i) {
        const double linear = 0.2 * (i + 1);
        EXPECT_NEAR(sheet.at(layout.cell_x(i) + 40, layout.cell_y(i) + 40, 0),
                    1.055 * std::pow(linear, 1 / 2.4) - 0.055, 0.51 / 255)
            << i;
    }
    inspect({"p_#.png", "--contact-sheet", "grey.png", "--columns", "2"});
    EXPECT_NEAR(read_png(folder_ / "grey.png").at(layout.cell_x(2) + 40, layout.cell_y(2) + 40, 1), 0.6f,
                0.01f);
    fs::remove(folder_ / "in_2.exr");
    const CommandResult gap =
        inspect({"in_#.exr", "--frames", "1-3", "--contact-sheet", "gap.png"}, ExitCode::partial);
    EXPECT_NE(gap.err.find("aftershade: error: in_2.exr: "), std::string::npos) << gap.err;
    EXPECT_NE(inspect({"in_1.exr", "--columns", "2"}, ExitCode::usage).err.find("--columns: error: is for"),
              std::string::npos);
}

TEST_F(Inspect, SaysThatThumbnailsNeedAColorWhereACaptureHasNone) {
    const Image ids(64, 36, 1);
    ExrWriteOptions options;
    options.data_window = options.display_window = {0, 0, 63, 35};
    const std::vector<ExrOutputChannel> channels = {{"object_id.I", PixelType::float32, &ids, 0}};
    write_exr(folder_ / "a_1.exr", channels, options);
    const std::string error =
        inspect({"a_1.exr", "--profile", "native", "--contact-sheet", "a.png", "--columns", "1"},
                ExitCode::capture)
            .err;
    EXPECT_NE(
        error.find(
            "a_1.exr: a thumbnail needs the role 'color', which the profile 'native' does not find among the "
            "channels object_id.I (--role color=FILE reads it"),
        std::string::npos)
        << error;
}

TEST_F(Inspect, ShowsTheOtherRolesWhereOneCannotBeDecoded) {
    Image ids(64, 4, 1);
    std::fill(ids.floats().begin(), ids.floats().end(), 1.5f);  // no whole number
    const Image color(64, 4, 1);
    const std::vector<ExrOutputChannel> channels = {{"R", PixelType::half, &color, 0},
                                                    {"G", PixelType::half, &color, 0},
                                                    {"B", PixelType::half, &color, 0},
                                                    {"object_id.I", PixelType::float32, &ids, 0}};
    ExrWriteOptions options;
    options.data_window = options.display_window = {0, 0, 63, 3};
    write_exr(folder_ / "a.exr", channels, options);
    inspect({"a.exr", "--contact-sheet", "a.png"});
    EXPECT_GT(read_png(folder_ / "a.png").width(), 448);
}

/// Stripes of two depths under a slant, as one sample in a pixel's middle or as the mean of a row of samples.
TEST_F(Inspect, NotesADepthThatIsAveragedOverSamples) {
    const auto write = [&](int samples) {
        Image depth(96, 64, 1);
        for (int y = 0; y < depth.height(); ++y)
            for (int x = 0; x < depth.width(); ++x)
                for (int i = 0; i < samples; ++i) {
                    const double at = x + 0.3 * y + (i + 0.5) / samples;
                    depth.at(x, y, 0) += float((std::fmod(at, 16) < 8 ? 4.0 : 7.0) / samples);
                }
        const Image color(96, 64, 1);
        const std::vector<ExrOutputChannel> channels = {{"R", PixelType::half, &color, 0},
                                                        {"G", PixelType::half, &color, 0},
                                                        {"B", PixelType::half, &color, 0},
                                                        {"Z", PixelType::float32, &depth, 0}};
        ExrWriteOptions options;
        options.data_window = options.display_window = {0, 0, 95, 63};
        write_exr(folder_ / "a.exr", channels, options);
    };
    const std::string averaged = "the depth is averaged over samples: at ";
    write(16);
    EXPECT_NE(json({"a.exr"})["notes"].dump().find(averaged), std::string::npos);
    write_text(folder_ / "capture.json", R"({"aftershade": 1, "frames": "a.exr",
        "channels": {"depth": {"channels": ["Z"], "sampling": "mean"}}})");
    EXPECT_EQ(json({"capture.json"})["notes"].dump().find(averaged), std::string::npos);
    write(1);
    EXPECT_EQ(json({"a.exr"})["notes"].dump().find(averaged), std::string::npos);
}

TEST_F(Inspect, WarnsOfDepthThatIsNoDepth) {
    Capture capture = make_capture({.width = 16, .height = 8, .background = {0.5f, 0.5f, 0.5f}});
    capture.images.at("depth").at(1, 0, 0) = std::nanf("");
    capture.images.at("depth").at(2, 0, 0) = -1;
    write_capture(capture, folder_ / "a.exr");
    const std::string warnings = json({"a.exr"})["warnings"].dump();
    EXPECT_NE(warnings.find("Z (role 'depth') has 1 NaN, read as no hit"), std::string::npos) << warnings;
    EXPECT_NE(warnings.find("depth is negative in places"), std::string::npos) << warnings;
    EXPECT_NE(inspect({"a.exr"}).out.find("\nwarning: "), std::string::npos);
}

TEST_F(Inspect, WarnsOfDepthThatOverflowedAHalf) {
    Image depth(64, 4, 1);
    for (float& value : depth.floats()) value = 4;
    depth.at(0, 0, 0) = 1e10f;
    const std::vector<ExrOutputChannel> channels = {{"R", PixelType::half, &depth, 0},
                                                    {"G", PixelType::half, &depth, 0},
                                                    {"B", PixelType::half, &depth, 0},
                                                    {"Z", PixelType::half, &depth, 0}};
    ExrWriteOptions options;
    options.data_window = options.display_window = {0, 0, 63, 3};
    write_exr(folder_ / "a.exr", channels, options);
    EXPECT_NE(json({"a.exr"})["warnings"].dump().find("is half and has 1 infinite values"),
              std::string::npos);
}

TEST_F(Inspect, ListsSubsampledChannelsWithTheReason) {
    AFTERSHADE_REQUIRE_CAPTURE(suite, "exr-suite");
    const Json luminance = json({(*suite / "Chromaticities/Rec709_YC.exr").string()});
    EXPECT_EQ(channel_named(luminance["parts"][0], "RY")["reason"], "subsampled 2 x 2");
    EXPECT_TRUE(channel_named(luminance["parts"][0], "RY")["nan"].is_null());
    EXPECT_TRUE(channel_named(luminance["parts"][0], "Y")["max"].is_number());
    EXPECT_EQ(luminance["roles"]["color"], Json::parse(R"(["Y"])"));
    const Json deep = json({(*suite / "v2/LowResLeftView/Trunks.exr").string()});
    // By oiiotool --stats.
    EXPECT_NEAR(channel_named(deep["parts"][0], "Z")["min"].get<double>(), 94.300232, 1e-4);
    EXPECT_NEAR(channel_named(deep["parts"][0], "Z")["max"].get<double>(), 991.630127, 1e-4);
}

TEST_F(Inspect, ReadsEveryFileOfOpenExrsSuiteAndBeachball) {
    AFTERSHADE_REQUIRE_CAPTURE(suite, "exr-suite");
    AFTERSHADE_REQUIRE_CAPTURE(beachball, "beachball");
    int files = 0;
    for (const fs::path& folder : {*suite, *beachball})
        for (const auto& entry : fs::recursive_directory_iterator(folder)) {
            if (entry.path().extension() != ".exr") continue;
            ++files;
            EXPECT_NE(inspect({entry.path().string()}).out, "");
            EXPECT_FALSE(json({entry.path().string()})["parts"].empty()) << entry.path();
        }
    EXPECT_GE(files, 40);
}

TEST_F(Inspect, EndsInOrderOnEveryDamagedFile) {
    AFTERSHADE_REQUIRE_CAPTURE(damaged, "exr-damaged");
    int files = 0;
    for (const auto& entry : fs::recursive_directory_iterator(*damaged)) {
        if (!entry.is_regular_file()) continue;
        ++files;
        const CommandResult result =
            run_aftershade({"inspect", entry.path().string(), "--json"}, folder_.path());
        EXPECT_TRUE(result.exit_code == 0 || result.exit_code == 3)
            << entry.path() << ": " << result.exit_code << result.err;
        if (!result.out.empty()) {
            EXPECT_TRUE(Json::accept(result.out)) << entry.path();
        }
    }
    EXPECT_GT(files, 100);
}

}  // namespace
}  // namespace aftershade::test
