#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

#include "framework/batch/process_codes.h"
#include "framework/file/png_file.h"
#include "tests/backends.h"
#include "tests/cli/command.h"
#include "tests/synthetic_capture.h"

namespace aftershade::test {
namespace {

namespace fs = std::filesystem;

const char* const kFilm = R"({ "aftershade": 1, "steps": [
    { "effect": "bokeh", "params": { "f_number": 0.5, "focus_distance": "2 m" } },
    { "effect": "view_transform", "params": { "exposure": 0.5 } } ] })";
const char* const kView = R"({ "aftershade": 1, "steps": [ { "effect": "view_transform" } ] })";
const char* const kNothing = R"({ "aftershade": 1, "steps": [] })";

/// IEC 61966-2-1 in double precision.
double srgb(double linear) {
    return linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055;
}

Capture still(int width = 64, int height = 36) {
    SyntheticScene scene{
        .width = width, .height = height, .background = {0.18f, 0.5f, 0.02f}, .background_depth_m = 6};
    scene.sphere = SyntheticSphere{20, 15, 9, 2};
    scene.points = {{50, 8, 30}};
    return make_capture(scene);
}

class Run : public testing::Test {
protected:
    Run() {
        write_text(folder_ / "film.json", kFilm);
        write_text(folder_ / "view.json", kView);
        write_text(folder_ / "nothing.json", kNothing);
        SyntheticScene scene{
            .width = 64, .height = 36, .background = {0.1f, 0.2f, 0.4f}, .background_depth_m = 8};
        scene.box = SyntheticBox{4, 6, 16, 12, 5, 2};
        for (int frame = 1; frame <= 3; ++frame)
            write_capture(make_capture(scene, frame), folder_ / ("in_000" + std::to_string(frame) + ".exr"));
    }

    CommandResult run(std::vector<std::string> arguments, const Environment& environment = {}) {
        arguments.insert(arguments.begin(), "run");
        CommandResult result = run_aftershade(arguments, folder_.path(), environment);
        EXPECT_EQ(result.exit_code, 0) << result.err;
        return result;
    }
    /// The bytes of what a run over the three frames wrote, by name; the files are removed.
    std::map<std::string, std::string> film(const std::vector<std::string>& more,
                                            const Environment& environment = {}) {
        std::vector<std::string> arguments{"film.json",    "in_####.exr", "-o",
                                           "out_####.exr", "-o",          "out_####.png"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        std::map<std::string, std::string> files;
        for (const std::string& path : lines_of_text(run(arguments, environment).out)) {
            files[path] = read_text(folder_ / path);
            fs::remove(folder_ / path);
        }
        return files;
    }
    Image color(const std::string& name) { return ExrFile(folder_ / name).read_floats(0, kRgba); }

    TemporaryFolder folder_;
};

TEST_F(Run, WritesAFileForEachFrameAndPatternAndPrintsTheirPaths) {
    const CommandResult result =
        run({"film.json", "in_####.exr", "-o", "out_%04d.exr", "-o", "out_####.png"});
    EXPECT_EQ(result.out,
              "out_0001.exr\nout_0001.png\nout_0002.exr\nout_0002.png\nout_0003.exr\nout_0003.png\n");
    for (const std::string& path : lines_of_text(result.out)) EXPECT_TRUE(fs::exists(folder_ / path)) << path;
    EXPECT_NE(result.err.find("profile native (channel "), std::string::npos) << result.err;
    EXPECT_NE(result.err.find("3 of 3 frames"), std::string::npos) << result.err;
    for (const auto& entry : fs::directory_iterator(folder_.path()))
        EXPECT_NE(entry.path().extension(), ".tmp") << entry.path();
}

TEST_F(Run, GivesTheSameBytesTwiceAndForAnyThreadsAndOnBothSoftwareBackends) {
    const auto first = film({});
    ASSERT_EQ(first.size(), 6u);
    EXPECT_EQ(film({}), first);
    EXPECT_EQ(film({}, {{"LP_NUM_THREADS", "0"}}), first);
    EXPECT_EQ(film({}, {{"LP_NUM_THREADS", "2"}}), first);
    EXPECT_EQ(film({"--backend", "egl-software"}), first);
    EXPECT_EQ(film({"--progress", "none"}), first);
}

TEST_F(Run, ReadsABareFileAndACaptureDocumentAlike) {
    const auto bare = film({"--frames", "2"});
    ASSERT_EQ(bare.size(), 2u);
    write_text(folder_ / "capture.json",
               R"({ "aftershade": 1, "frames": "in_####.exr", "range": "1-3", "profile": "native" })");
    run({"film.json", "capture.json", "--frames", "2", "-o", "out_####.exr"});
    EXPECT_EQ(read_text(folder_ / "out_0002.exr"), bare.at("out_0002.exr"));
    run({"film.json", "in_0002.exr", "-o", "single_####.exr"});
    EXPECT_EQ(read_text(folder_ / "single_0002.exr"), bare.at("out_0002.exr"));
}

TEST_F(Run, PutsSetAboveTheLook) {
    write_capture(still(), folder_ / "still.exr");
    run({"film.json", "still.exr", "-o", "look.exr"});
    run({"film.json", "still.exr", "-o", "set.exr", "--set", "bokeh.focus_distance=6 m", "--set",
         "bokeh.f_number=8"});
    write_text(folder_ / "other.json", R"({ "aftershade": 1, "steps": [
        { "effect": "bokeh", "params": { "f_number": 8, "focus_distance": "600 cm" } },
        { "effect": "view_transform", "params": { "exposure": 0.5 } } ] })");
    run({"other.json", "still.exr", "-o", "other.exr"});
    const Image look = color("look.exr"), set = color("set.exr"), other = color("other.exr");
    EXPECT_FALSE(std::ranges::equal(look.floats(), set.floats()));
    EXPECT_TRUE(std::ranges::equal(other.floats(), set.floats()));
}

TEST_F(Run, TakesTheLastOfTwoSetsOfOneParameter) {
    write_capture(still(), folder_ / "still.exr");
    run({"view.json", "still.exr", "-o", "once.png", "--set", "view_transform.exposure=1"});
    run({"view.json", "still.exr", "-o", "twice.png", "--set", "view_transform.exposure=-3", "--set",
         "view_transform.exposure=1 ev"});
    EXPECT_EQ(read_text(folder_ / "twice.png"), read_text(folder_ / "once.png"));
}

TEST_F(Run, WritesTapsBesideTheFirstOutput) {
    fs::create_directory(folder_ / "made");
    const CommandResult result =
        run({"film.json", "in_####.exr", "--frames", "3,1", "-o", "made/take10_####.exr", "--tap",
             "bokeh.coc", "--tap", "view_transform.display"});
    EXPECT_EQ(
        result.out,
        "made/take10_0003.exr\nmade/take10.bokeh.coc.0003.exr\nmade/take10.view_transform.display.0003.exr\n"
        "made/take10_0001.exr\nmade/take10.bokeh.coc.0001.exr\nmade/"
        "take10.view_transform.display.0001.exr\n");
    const ExrFile coc(folder_ / "made/take10.bokeh.coc.0003.exr");
    ASSERT_EQ(coc.parts()[0].channels.size(), 1u);
    EXPECT_EQ(coc.parts()[0].channels[0].name, "Y");
    EXPECT_EQ(coc.parts()[0].channels[0].type, PixelType::float32);
    // Equation 2.1 of Post 2013 (glsl/lens/coc.glsl), in px of a 64 px wide picture: A f (z - S1) / (z (S1 -
    // f)), half of the diameter.
    const double focal_m = 0.05, focus_m = 2, f_number = 0.5, depth_m = 8, px_per_m = 64 / 0.036;
    const double radius_px = 0.5 * (focal_m / f_number) * focal_m * (depth_m - focus_m) /
                             (depth_m * (focus_m - focal_m)) * px_per_m;
    EXPECT_NEAR(coc.read_floats(0, std::vector<std::string>{"Y"}).at(60, 30, 0), radius_px, 1e-4 * radius_px);
}

TEST_F(Run, DrawsATapInFalseColorIntoThePngThatItNames) {
    write_capture(still(), folder_ / "still.exr");
    const CommandResult result = run({"film.json", "still.exr", "-o", "out.exr", "--tap", "bokeh.coc=coc.png",
                                      "--tap", "bokeh.near=near.exr"});
    EXPECT_EQ(result.out, "out.exr\ncoc.png\nnear.exr\n");
    const Image picture = read_png(folder_ / "coc.png");
    EXPECT_EQ(picture.width(), still().header.data_window.width());
    EXPECT_EQ(picture.channels(), 3);
    EXPECT_EQ(ExrFile(folder_ / "near.exr").parts()[0].channels[0].name, "Y");
}

TEST_F(Run, CarriesAttributesAndWindowsOverAndAddsItsOwn) {
    const Capture capture = still();
    const Image& image = capture.images.at("color");
    std::vector<ExrOutputChannel> channels;
    for (int c = 0; c < 4; ++c) channels.push_back({kRgba[std::size_t(c)], PixelType::half, &image, c});
    ExrWriteOptions options;
    options.data_window = {5, -3, 68, 32};
    options.display_window = {0, 0, 79, 44};
    options.pixel_aspect = 2;
    const std::vector<float> primaries{0.713f, 0.293f, 0.165f, 0.83f, 0.128f, 0.044f, 0.3217f, 0.3377f};
    options.attributes = {{"owner", "a person"}, {"shot/take", 12}, {"chromaticities", primaries}};
    write_exr(folder_ / "tagged_0007.exr", channels, options);
    for (const char* backend : {"osmesa", "egl-software"}) {
        if (!gpu::why_not(*gpu::parse_backend(backend)).empty()) continue;
        run({"view.json", "tagged_0007.exr", "-o", "out.exr", "--backend", backend});
        const ExrFile out(folder_ / "out.exr");
        const ExrPart& part = out.parts()[0];
        EXPECT_EQ(part.data_window, options.data_window);
        EXPECT_EQ(part.display_window, options.display_window);
        EXPECT_EQ(part.pixel_aspect, 2);
        EXPECT_EQ(part.metadata.text("owner"), "a person");
        EXPECT_EQ(part.metadata.number("shot/take"), 12);
        EXPECT_EQ(part.metadata.value("chromaticities"), ExrValue(primaries));
        EXPECT_EQ(part.metadata.text("aftershade/look"), "view.json");
        EXPECT_EQ(part.metadata.text("aftershade/profile"), "native");
        EXPECT_EQ(part.metadata.number("aftershade/frame"), 7);
        EXPECT_NE(part.metadata.text("aftershade/renderer").value_or("").find("llvmpipe"), std::string::npos);
    }
}

TEST_F(Run, WritesHalfOrFloatColorAndOtherRolesInTheirOwnTypes) {
    run({"view.json", "in_0001.exr", "-o", "out.exr", "--output-roles", "color,depth,velocity,object_id"});
    const auto type = [&](const std::string& name) {
        const ExrFile out(folder_ / "out.exr");
        for (const ExrChannel& channel : out.parts()[0].channels)
            if (channel.name == name) return std::string(pixel_type_name(channel.type));
        return std::string("absent");
    };
    EXPECT_EQ(type("R"), "half");
    EXPECT_EQ(type("A"), "half");
    EXPECT_EQ(type("Z"), "float");
    EXPECT_EQ(type("velocity.X"), "float");
    EXPECT_EQ(type("object_id.I"), "uint");
    EXPECT_EQ(type("albedo.R"), "absent");
    run({"view.json", "in_0001.exr", "-o", "out.exr", "--pixel-type", "float"});
    EXPECT_EQ(type("R"), "float");
    EXPECT_EQ(type("Z"), "absent");
    // No step of the look makes color: the input's comes out bit for bit.
    EXPECT_TRUE(std::ranges::equal(color("out.exr").floats(), color("in_0001.exr").floats()));
}

/// Each byte of the picture is the nearest to `expected`; a tie may fall to either side.
template <typename Expected>
void expect_bytes(const Image& picture, Expected expected) {
    for (int y = 0; y < picture.height(); ++y)
        for (int x = 0; x < picture.width(); ++x)
            for (int c = 0; c < picture.channels(); ++c)
                ASSERT_NEAR(picture.at(x, y, c) * 255, 255 * std::clamp(expected(x, y, c), 0.0, 1.0), 0.505)
                    << "at " << x << ", " << y << ", channel " << c;
}

TEST_F(Run, EncodesPicturesAsTheSrgbFormulaSaysWithAndWithoutAViewTransform) {
    const Capture capture = still();
    write_capture(capture, folder_ / "still.exr");
    const Image& light = capture.images.at("color");
    for (const char* look : {"nothing.json", "view.json"}) {
        run({look, "still.exr", "-o", "out.png"});
        const Image picture = read_png(folder_ / "out.png");
        ASSERT_EQ(picture.channels(), 3) << "an opaque picture has no alpha";
        expect_bytes(picture, [&](int x, int y, int c) { return srgb(double(light.at(x, y, c))); });
    }
    run({"view.json", "still.exr", "-o", "out.png", "--set", "view_transform.exposure=2"});
    expect_bytes(read_png(folder_ / "out.png"),
                 [&](int x, int y, int c) { return srgb(4 * double(light.at(x, y, c))); });
}

TEST_F(Run, DividesAlphaOutForPictures) {
    SyntheticScene scene{.width = 16, .height = 9, .background = {0.8f, 0.1f, 0.4f}, .alpha = 0.25f};
    Capture capture = make_capture(scene);
    for (int c = 0; c < 4; ++c) capture.images["color"].at(3, 2, c) = 0;
    write_capture(capture, folder_ / "glass.exr");
    for (const char* look : {"nothing.json", "view.json"}) {
        run({look, "glass.exr", "-o", "out.png"});
        const Image picture = read_png(folder_ / "out.png");
        ASSERT_EQ(picture.channels(), 4) << look;
        const double straight[] = {srgb(0.8), srgb(0.1), srgb(0.4), 0.25};
        expect_bytes(picture, [&](int x, int y, int c) { return x == 3 && y == 2 ? 0.0 : straight[c]; });
    }
}

TEST_F(Run, PlacesASmallerDataWindowInThePicture) {
    Capture capture = make_capture({.width = 8, .height = 6, .background = {0.5f, 0.25f, 1}});
    capture.header.data_window = {3, 2, 10, 7};
    capture.header.display_window = {1, 1, 16, 9};
    write_capture(capture, folder_ / "small.exr");
    for (const char* look : {"nothing.json", "view.json"}) {
        run({look, "small.exr", "-o", "out.png"});
        const Image picture = read_png(folder_ / "out.png");
        ASSERT_EQ(picture.width(), 16);
        ASSERT_EQ(picture.height(), 9);
        const double inside[] = {srgb(0.5), srgb(0.25), 1, 1};
        const auto expected = [&](int x, int y, int c) {
            return capture.header.data_window.contains(x + 1, y + 1) ? inside[c] : 0.0;
        };
        ASSERT_EQ(picture.channels(), 4);
        expect_bytes(picture, expected);
    }
}

TEST_F(Run, CropsOverscanFromThePictureAndKeepsItInTheExr) {
    SyntheticScene scene{.width = 12, .height = 10, .background = {0.2f, 0.2f, 0.2f}};
    scene.points = {{2, 3, 0.6f}};
    Capture capture = make_capture(scene);
    capture.header.data_window = {-2, -3, 9, 6};
    capture.header.display_window = {0, 0, 7, 3};
    write_capture(capture, folder_ / "overscan.exr");
    run({"view.json", "overscan.exr", "-o", "out.png", "-o", "out.exr"});
    const Image picture = read_png(folder_ / "out.png");
    ASSERT_EQ(picture.width(), 8);
    ASSERT_EQ(picture.height(), 4);
    ASSERT_EQ(picture.channels(), 3) << "the part that is seen is opaque";
    expect_bytes(picture, [](int x, int y, int) { return srgb(x == 0 && y == 0 ? 0.8 : 0.2); });
    EXPECT_EQ(ExrFile(folder_ / "out.exr").parts()[0].data_window, capture.header.data_window);
}

TEST_F(Run, ReplacesAnOlderOutput) {
    write_text(folder_ / "out.exr", "the older file");
    run({"view.json", "in_0001.exr", "-o", "out.exr"});
    EXPECT_NO_THROW(color("out.exr"));
}

TEST_F(Run, HonoursTheBackendOfTheEnvironmentAndPutsTheOptionAboveIt) {
    const auto backend_of = [&](const Environment& environment, std::vector<std::string> more) {
        more.insert(more.begin(), {"view.json", "in_0001.exr", "-o", "out.exr", "--progress", "plain"});
        for (const std::string& line : lines_of_text(run(more, environment).err))
            if (const std::size_t end = line.find(": llvmpipe"); end != std::string::npos) {
                const std::size_t begin = line.rfind(' ', end) + 1;
                return line.substr(begin, end - begin);
            }
        return std::string("none");
    };
    SKIP_WITHOUT(gpu::Backend::egl_software);
    EXPECT_EQ(backend_of({{"AFTERSHADE_BACKEND", "egl-software"}}, {}), "egl-software");
    EXPECT_EQ(backend_of({{"AFTERSHADE_BACKEND", "no such thing"}}, {"--backend", "egl-software"}),
              "egl-software");
    SKIP_WITHOUT(gpu::Backend::osmesa);
    EXPECT_EQ(backend_of({{"AFTERSHADE_BACKEND", "osmesa"}}, {}), "osmesa");
    EXPECT_EQ(backend_of({{"AFTERSHADE_BACKEND", "egl-software"}}, {"--backend", "osmesa"}), "osmesa");
}

TEST_F(Run, TakesWhicheverSoftwareBackendIsThereAndDrawsTheSameBits) {
    SKIP_WITHOUT(gpu::Backend::egl_software);
    SKIP_WITHOUT(gpu::Backend::osmesa);
    std::set<std::string> files;
    for (const auto& [hidden, taken] : std::map<std::string, std::string>{
             {"none", "egl-software"}, {"libOSMesa", "egl-software"}, {"libEGL", "osmesa"}}) {
        const CommandResult result =
            run({"view.json", "in_0001.exr", "-o", "out.exr", "--overwrite", "--backend", "software"},
                without_gl(folder_ / hidden, {hidden}));
        EXPECT_NE(result.err.find(taken + ": llvmpipe"), std::string::npos) << result.err;
        EXPECT_EQ(result.err.find("install"), std::string::npos) << result.err;
        files.insert(read_text(folder_ / "out.exr"));
    }
    EXPECT_EQ(files.size(), 1u);
}

TEST_F(Run, OffersTheOtherSoftwareBackendWhereTheOneItWasToldIsAbsent) {
    SKIP_WITHOUT(gpu::Backend::egl_software);
    const CommandResult result =
        run_aftershade({"run", "view.json", "in_0001.exr", "-o", "out.exr", "--backend", "osmesa"},
                       folder_.path(), without_gl(folder_ / "hidden", {"libOSMesa"}));
    EXPECT_EQ(result.exit_code, int(ExitCode::gl));
    EXPECT_NE(result.err.find("'egl-software' works here and draws the same bits"), std::string::npos)
        << result.err;
}

TEST(Doctor, PrintsALineForEachBackend) {
    const TemporaryFolder folder;
    const CommandResult result = run_aftershade({"doctor"}, folder.path());
    EXPECT_EQ(result.exit_code, 0) << result.out;
    const auto lines = lines_of_text(result.out);
    ASSERT_GE(lines.size(), 8u) << result.out;
    EXPECT_TRUE(lines[0].starts_with("backend       usable  renderer"));
    EXPECT_TRUE(lines[1].starts_with("egl  "));
    EXPECT_TRUE(lines[2].starts_with("egl-software  "));
    EXPECT_TRUE(lines[3].starts_with("osmesa  ")) << lines[3];
    EXPECT_TRUE((lines[2] + lines[3]).find("yes     llvmpipe") != std::string::npos) << result.out;
    EXPECT_TRUE(lines[4].starts_with("cpu  "));
    EXPECT_TRUE(lines[5].starts_with("draws with    fragment on ")) << lines[5];
    EXPECT_NE(result.out.find("\nplug-ins  "), std::string::npos) << result.out;
    for (const char* const kind : {"Landlock", "seccomp", "rlimits: ", "control group: "})
        EXPECT_NE(result.out.find(kind), std::string::npos) << kind;
}

TEST(Doctor, SaysWhatAProcessOfPluginsHolds) {
    const TemporaryFolder folder;
    const std::vector<std::string> limited{"/bin/sh", "-c", "ulimit -v 3000000; exec \"$0\" doctor --json",
                                           AFTERSHADE_EXECUTABLE};
    for (const auto& [words, kilobytes] :
         {std::pair{std::vector<std::string>{AFTERSHADE_EXECUTABLE, "doctor", "--json"}, 4194304u},
          {limited, 3000000u}}) {
        const CommandResult result = Command(words, folder.path()).wait();
        const auto plugins = nlohmann::json::parse(result.out).at("plugins");
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
        EXPECT_EQ(plugins.at("rlimits").at("address_space_bytes"), kilobytes * 1024ull)
            << "the limit of the shell where it is lower";
#endif
        EXPECT_EQ(plugins.at("rlimits").at("open_files"), 256);
        EXPECT_EQ(plugins.at("rlimits").at("file_bytes"), 0);
        EXPECT_TRUE(plugins.at("control_group").contains("memory_bytes"));
        const bool says_threads = plugins.at("not_prevented").dump().find("threads") != std::string::npos;
        EXPECT_EQ(plugins.at("threads").is_null(), says_threads) << "what is missing is said";
    }
}

TEST(Doctor, PrintsJson) {
    const TemporaryFolder folder;
    const CommandResult result = run_aftershade({"doctor", "--json"}, folder.path());
    const auto report = nlohmann::json::parse(result.out);
    EXPECT_EQ(report.at("aftershade"), 1);
    EXPECT_GT(report.at("cpu").at("threads").get<int>(), 0);
    std::vector<std::string> names;
    for (const auto& row : report.at("backends")) {
        names.push_back(row.at("backend"));
        if (row.at("usable").get<bool>()) EXPECT_FALSE(row.at("renderer").get<std::string>().empty());
        else EXPECT_FALSE(row.at("reason").get<std::string>().empty());
    }
    EXPECT_EQ(names, (std::vector<std::string>{"egl", "egl-software", "osmesa"}));
    for (const auto& row : report.at("backends"))
        EXPECT_EQ(row.value("software", row.at("backend") != "egl"), row.at("backend") != "egl");
}

TEST(Doctor, ExitsWithFourAndSaysWhyNothingIsUsable) {
    const TemporaryFolder folder;
    const CommandResult result =
        run_aftershade({"doctor", "--json"}, folder.path(), without_gl(folder / "no_gl"));
    EXPECT_EQ(result.exit_code, int(ExitCode::gl));
    const auto report = nlohmann::json::parse(result.out);
    for (const auto& row : report.at("backends")) {
        EXPECT_FALSE(row.at("usable").get<bool>());
        // The libraries are there and damaged: to install them would not help.
        EXPECT_NE(row.at("reason").get<std::string>().find("the loader refuses it"), std::string::npos)
            << row;
    }
}

TEST_F(Run, PlainlyGivesTheSameBits) {
    SKIP_WITHOUT(gpu::test_backend());
    run({"film.json", "in_####.exr", "-o", "fast_####.exr"});
    run({"film.json", "in_####.exr", "-o", "plain_####.exr", "--plain"});
    for (const std::string frame : {"0001.exr", "0003.exr"})
        EXPECT_TRUE(read_text(folder_ / ("plain_" + frame)) == read_text(folder_ / ("fast_" + frame)));
}

}  // namespace
}  // namespace aftershade::test
