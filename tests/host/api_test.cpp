// The public API over small frames: what the program writes is what a library's user gets.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "aftershade/host.h"
#include "framework/file/exr_file.h"
#include "tests/host/host_setup.h"
#include "tests/synthetic_capture.h"
#include "tests/temporary_folder.h"

namespace {

using namespace aftershade::host;
using namespace aftershade::test;

TEST(HostApi, RendersWhatTheProgramWrites) {
    const TemporaryFolder folder;
    const std::string look = folder.path() / "look.json", out = folder.path() / "out.exr";
    write_file(look, kBlurLook);
    const std::string frame = std::string(AFTERSHADE_SOURCE_DIR) + "/scenes/suzanne";
    ASSERT_EQ(std::system(("\"" AFTERSHADE_EXECUTABLE "\" run " + look + " " + frame + " -o " + out +
                           " --frames 3 --backend software --pixel-type float --scale 1/4 --progress none")
                              .c_str()),
              0);
    Host host(on_software());
    Look from_file = host.load_look(look);
    const Capture capture = from_file.read(frame, {.scale_divisor = 4});
    const Result result = from_file.render(capture);
    const aftershade::ExrFile written(out);
    const std::vector<std::string> channels = {"R", "G", "B", "A"};
    const auto expected = written.read_floats(0, channels);
    const Image image = result.image("color");
    ASSERT_EQ(image.floats().size(), expected.floats().size());
    EXPECT_TRUE(std::ranges::equal(image.floats(), expected.floats()));
}

TEST(HostApi, RendersWhatTheProgramWritesWherePixelsAreNotSquareToo) {
    const TemporaryFolder folder;
    const std::string look = folder.path() / "look.json", in = folder.path() / "in.exr",
                      out = folder.path() / "out.exr";
    write_file(look, kBlurLook);
    aftershade::Capture frame = make_capture({.width = 51,
                                              .height = 33,
                                              .background = {0.1f, 0.2f, 0.4f},
                                              .background_depth_m = 2,
                                              .points = {{20, 10, 50}, {40, 25, 9}}});
    frame.header.pixel_aspect = 1.5f;
    write_capture(frame, in);
    ASSERT_EQ(std::system(("\"" AFTERSHADE_EXECUTABLE "\" run " + look + " " + in + " -o " + out +
                           " --backend software --pixel-type float --progress none")
                              .c_str()),
              0);
    Host host(on_software());
    Look from_file = host.load_look(look);
    const Result result = from_file.render(from_file.read(in));
    const std::vector<std::string> channels = {"R", "G", "B", "A"};
    const auto expected = aftershade::ExrFile(out).read_floats(0, channels);
    EXPECT_EQ(result.image("color").width(), 51);
    EXPECT_TRUE(std::ranges::equal(result.image("color").floats(), expected.floats()));
    const auto square = [](const std::string& text) {
        return text.find("77 x 33 square") != std::string::npos;
    };
    EXPECT_TRUE(std::ranges::any_of(result.messages(), square));
}

TEST(HostApi, ArraysGiveTheBitsOfFiles) {
    Host host(on_software());
    Look look = host.parse_look(kBlurLook);
    const Capture read =
        look.read(std::string(AFTERSHADE_SOURCE_DIR) + "/scenes/suzanne", {.scale_divisor = 4});
    Capture arrays(read.data_window().width, read.data_window().height);
    arrays.set_windows(read.data_window(), read.display_window());
    arrays.set_camera(read.camera());
    arrays.set_scale(read.scale());
    arrays.set_frame(read.frame());
    for (const std::string& role : read.roles()) {
        const Image image = read.image(role);
        arrays.set_image(role, {image.data(), image.type(), image.width(), image.height(), image.channels()});
    }
    EXPECT_TRUE(same_bits(look.render(arrays).image("color"), look.render(read).image("color")));
}

TEST(HostApi, ArraysOfPixelsThatAreNotSquareGiveTheBitsOfFiles) {
    const TemporaryFolder folder;
    const Image pixels = small_capture().image("color");
    const int width = pixels.width(), height = pixels.height();
    aftershade::Image stored(width, height, 4);
    std::copy_n(static_cast<const float*>(pixels.data()), stored.floats().size(), stored.floats().begin());
    std::vector<aftershade::ExrOutputChannel> channels;
    for (int c = 0; c < 4; ++c)
        channels.push_back({std::string(1, "RGBA"[c]), aftershade::PixelType::float32, &stored, c});
    aftershade::ExrWriteOptions options;
    options.data_window = options.display_window = {0, 0, width - 1, height - 1};
    options.pixel_aspect = 2;
    aftershade::write_exr(folder.path() / "a.exr", channels, options);
    Host host(on_software());
    Look look = host.parse_look(R"({"aftershade": 1, "steps": [{"effect": "bloom"}]})");
    const Capture read = look.read(folder.path() / "a.exr");
    EXPECT_EQ(read.pixel_aspect(), 2);
    Capture arrays(width, height);
    arrays.set_image("color", {pixels.data(), pixels.type(), width, height, 4});
    const Result square = look.render(arrays);
    arrays.set_pixel_aspect(2);
    const Result result = look.render(arrays);
    EXPECT_TRUE(same_bits(result.image("color"), look.render(read).image("color")));
    EXPECT_FALSE(same_bits(result.image("color"), square.image("color")));
    result.write(folder.path() / "o.exr", {.roles = {"color"}});
    EXPECT_EQ(aftershade::ExrFile(folder.path() / "o.exr").parts()[0].pixel_aspect, 2);
    for (const double aspect : {0.0, -1.0, 101.0, std::nan("")})
        EXPECT_THROW(arrays.set_pixel_aspect(aspect), Error) << aspect;
}

TEST(HostApi, TakesKeysWithAnEaseOfTheirOwn) {
    Host host(on_software());
    Look look = host.parse_look(R"({"aftershade": 1, "steps": [{"effect": "color_grade"}]})");
    Capture capture = small_capture();
    capture.set_frame(12);
    const auto drawn = [&](const Value& exposure) {
        look.set("color_grade.exposure", exposure);
        return look.render(capture);
    };
    const Result held = drawn(Json{
        R"({"keys": {"1": {"value": 2, "interpolation": "step"}, "23": 4}, "interpolation": "smooth"})"});
    EXPECT_TRUE(same_bits(held.image("color"), drawn(2.0).image("color")));
    const Result eased =
        drawn(Json{R"({"keys": {"1": {"value": 2, "interpolation": [0.5, 0, 0.5, 1]}, "23": 4}})"});
    EXPECT_TRUE(same_bits(eased.image("color"), drawn(3.0).image("color")))
        << "half-way, by the curve's symmetry";
}

TEST(HostApi, WritesOverNoDocumentOfItsOwnLookAndKnowsNoOtherHosts) {
    const TemporaryFolder folder;
    const std::string look = R"({"aftershade": 1, "steps": [{"effect": "vignette"}]})";
    const auto own = folder.path() / "own.png", others = folder.path() / "others.png";
    write_file(own, look);
    write_file(others, look);
    Host host(on_software()), other(on_software());
    other.load_look(others);
    const Result result = host.load_look(own).render(small_capture());
    const WriteOptions color{.roles = {"color"}};
    try {
        result.write(own, color);
        ADD_FAILURE() << "the look was replaced";
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::usage);
        EXPECT_NE(std::string(error.what()).find("would replace the input"), std::string::npos)
            << error.what();
    }
    EXPECT_EQ(std::filesystem::file_size(own), look.size());
    result.write(others, color);
    EXPECT_NE(std::filesystem::file_size(others), look.size());
}

}  // namespace
