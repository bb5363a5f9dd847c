// Real files of other people's making, read as their own tools read them.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <map>
#include <string>
#include <vector>

#include <OpenEXR/ImfArray.h>
#include <OpenEXR/ImfRgbaFile.h>
#include <gtest/gtest.h>

#include "framework/capture/capture.h"
#include "framework/capture/frame_file.h"
#include "tests/file/image_files.h"

namespace aftershade::test {
namespace {

namespace fs = std::filesystem;

std::vector<fs::path> exr_files(const fs::path& folder) {
    std::vector<fs::path> files;
    for (const auto& entry : fs::recursive_directory_iterator(folder))
        if (entry.path().extension() == ".exr") files.push_back(entry.path());
    std::sort(files.begin(), files.end());
    return files;
}

/// Some channels of a part, and where oiiotool is to write them.
struct Extract {
    int part = 0;
    std::vector<std::string> channels;
    fs::path raw;
};

std::vector<Extract> extracts_of(const ExrFile& file, const TemporaryFolder& folder) {
    std::vector<Extract> extracts;
    for (int part = 0; part < int(file.parts().size()); ++part) {
        const ExrPart& info = file.parts()[std::size_t(part)];
        const auto subsampled = [](const ExrChannel& c) { return c.x_sampling != 1 || c.y_sampling != 1; };
        // OpenImageIO refuses both.
        if (info.type.starts_with("deep") ||
            std::any_of(info.channels.begin(), info.channels.end(), subsampled))
            continue;
        for (std::size_t i = 0; i < info.channels.size(); i += 3) {
            Extract extract{part, {}, folder / (std::to_string(extracts.size()) + ".tif")};
            for (std::size_t j = i; j < std::min(i + 3, info.channels.size()); ++j)
                extract.channels.push_back(info.channels[j].name);
            extracts.push_back(std::move(extract));
        }
    }
    return extracts;
}

/// Uncompressed float TIFF, which OpenImageIO ends with the pixels where there are no attributes, in one run
/// for the file.
bool run_oiiotool(const fs::path& file, const std::vector<Extract>& extracts) {
    // Without --noautocrop it would fit the data window to the display window, which TIFF has alone.
    std::string command = "oiiotool --noautocrop";
    for (const Extract& extract : extracts) {
        std::string list;
        for (const std::string& name : extract.channels) list += (list.empty() ? "" : ",") + name;
        command += " '" + file.string() + "' --subimage " + std::to_string(extract.part) + " --ch '" + list +
                   "' --eraseattrib '.*' -d float --scanline --compression none -o '" + extract.raw.string() +
                   "'";
    }
    return std::system((command + " >/dev/null").c_str()) == 0;
}

bool same_values(std::span<const float> ours, std::span<const char> theirs) {
    for (std::size_t i = 0; i < ours.size(); ++i) {
        float value;
        std::memcpy(&value, theirs.data() + i * sizeof value, sizeof value);
        if (ours[i] != value && !(std::isnan(ours[i]) && std::isnan(value))) return false;
    }
    return true;
}

void expect_as_oiiotool_reads(const fs::path& path) {
    const TemporaryFolder folder;
    const ExrFile file(path);
    const std::vector<Extract> extracts = extracts_of(file, folder);
    if (extracts.empty()) return;
    ASSERT_TRUE(run_oiiotool(path, extracts)) << path;
    for (const Extract& extract : extracts) {
        const std::string bytes = read_text(extract.raw);
        const Image image = file.read_floats(extract.part, extract.channels);
        const std::size_t size = image.floats().size_bytes();
        ASSERT_GT(bytes.size(), size) << path;
        EXPECT_TRUE(same_values(image.floats(), std::span(bytes).last(size)))
            << path << " part " << extract.part << " " << extract.channels[0];
    }
}

class ProducerFolder : public testing::TestWithParam<const char*> {};

TEST_P(ProducerFolder, IsReadAsOiiotoolReadsIt) {
    AFTERSHADE_REQUIRE_CAPTURE(folder, GetParam());
    if (std::system("command -v oiiotool >/dev/null") != 0) GTEST_SKIP() << "SKIPPED: no oiiotool";
    const std::vector<fs::path> files = exr_files(*folder);
    ASSERT_GE(files.size(), 9u);
    for (const fs::path& file : files) expect_as_oiiotool_reads(file);
}

INSTANTIATE_TEST_SUITE_P(All, ProducerFolder, testing::Values("exr-suite", "beachball"),
                         [](const auto& suite) { return suite.index == 0 ? "exr_suite" : "beachball"; });

Sequence bare_file(const fs::path& path, const std::string& profile = "native") {
    Sequence sequence;
    sequence.files = FramePattern(path.string());
    sequence.profile = profile;
    return sequence;
}

Capture read_capture(const Sequence& sequence, const std::vector<std::string>& roles, int frame = 1) {
    Diagnostics diagnostics;
    return CaptureReader(sequence, read_profiles(AFTERSHADE_SOURCE_DIR "/profiles", diagnostics), {})
        .read(frame, roles);
}

class LuminanceChroma : public testing::TestWithParam<const char*> {};

TEST_P(LuminanceChroma, IsReadAsOpenExrsOwnConverterReadsIt) {
    AFTERSHADE_REQUIRE_CAPTURE(folder, "exr-suite");
    const fs::path path = *folder / "Chromaticities" / GetParam();
    Sequence sequence = bare_file(path);
    Imf::RgbaInputFile reference(path.c_str());
    const Imath::Box2i window = reference.dataWindow();
    const int width = window.max.x - window.min.x + 1, height = window.max.y - window.min.y + 1;
    Imf::Array2D<Imf::Rgba> pixels(height, width);
    reference.setFrameBuffer(&pixels[-window.min.y][-window.min.x], 1, std::size_t(width));
    reference.readPixels(window.min.y, window.max.y);

    const ExrFile file(path);
    const Image image = file.read_luminance_chroma(0);
    ASSERT_EQ(image.width(), width);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const Imf::Rgba& expected = pixels[y][x];
            ASSERT_EQ(image.at(x, y, 0), float(expected.r)) << x << " " << y;
            ASSERT_EQ(image.at(x, y, 1), float(expected.g)) << x << " " << y;
            ASSERT_EQ(image.at(x, y, 2), float(expected.b)) << x << " " << y;
        }
    EXPECT_EQ(read_capture(sequence, {"color"}).images.at("color").width(), width);
}

INSTANTIATE_TEST_SUITE_P(Files, LuminanceChroma, testing::Values("Rec709_YC.exr", "XYZ_YC.exr"),
                         [](const auto& suite) { return suite.index == 0 ? "Rec709_YC" : "XYZ_YC"; });

TEST(Chromaticities, OfXyzAreConvertedToRec709) {
    AFTERSHADE_REQUIRE_CAPTURE(folder, "exr-suite");
    const Capture xyz = read_capture(bare_file(*folder / "Chromaticities/XYZ.exr"), {"color"});
    const Capture rec709 = read_capture(bare_file(*folder / "Chromaticities/Rec709.exr"), {"color"});
    double largest = 0;
    for (std::size_t i = 0; i < xyz.images.at("color").floats().size(); ++i)
        largest = std::max(largest, std::abs(double(xyz.images.at("color").floats()[i]) -
                                             rec709.images.at("color").floats()[i]));
    RecordProperty("largest_difference", std::to_string(largest));
    EXPECT_LE(largest, 0.01);
    EXPECT_EQ(name_of_primaries(xyz.header.primaries), "rec709");
}

/// The value of one role at a pixel of the display window, if the frame has that pixel.
std::optional<float> value_at(const Capture& capture, const std::string& role, int x, int y, int channel) {
    const Window& window = capture.header.data_window;
    if (!window.contains(x, y)) return std::nullopt;
    return capture.images.at(role).at(x - window.min_x, y - window.min_y, channel);
}

TEST(Beachball, IsTheSameInOnePartAndInMany) {
    AFTERSHADE_REQUIRE_CAPTURE(folder, "beachball");
    for (const std::string view : {"right", "left"}) {
        Sequence single = bare_file(*folder / "singlepart.0001.exr", "nuke");
        Sequence multi = bare_file(*folder / "multipart.0001.exr", "nuke");
        single.view = multi.view = view;
        const std::vector<std::string> roles = {"color", "depth", "velocity_next"};
        const Capture a = read_capture(single, roles), b = read_capture(multi, roles);
        EXPECT_EQ(a.header.view, view);
        int compared = 0;
        for (int y = 0; y < 1556; ++y)
            for (int x = 0; x < 2048; ++x) {
                const auto first = value_at(a, "color", x, y, 0), second = value_at(b, "color", x, y, 0);
                if (!first || !second) continue;
                ++compared;
                ASSERT_EQ(*first, *second) << view << " " << x << " " << y;
                ASSERT_EQ(value_at(a, "velocity_next", x, y, 0), value_at(b, "velocity_next", x, y, 0))
                    << x << " " << y;
            }
        EXPECT_GT(compared, 500000) << view;
    }
}

TEST(Beachball, HasTheRightEyeByDefaultAndRefusesAViewThatItHasNot) {
    AFTERSHADE_REQUIRE_CAPTURE(folder, "beachball");
    for (const std::string file : {"singlepart.0001.exr", "multipart.0001.exr"}) {
        const FrameFile frame(*folder / file, {}, "");
        EXPECT_EQ(frame.view(), "right");
        EXPECT_EQ(frame.views(), (std::vector<std::string>{"right", "left"})) << file;
        const std::string message = capture_error([&] { FrameFile(*folder / file, {}, "middle"); });
        EXPECT_NE(message.find("'right' and 'left'"), std::string::npos) << message;
    }
}

TEST(Beachball, PlacesPartsOfOtherWindowsInTheColorsGrid) {
    AFTERSHADE_REQUIRE_CAPTURE(folder, "beachball");
    Sequence sequence = bare_file(*folder / "multipart.0003.exr", "nuke");
    sequence.view = "left";
    const Capture capture = read_capture(sequence, {"color", "velocity_next", "depth"});
    // rgba_left and forward_left share a window of 880 x 855 at (897, 481); depth_left too.
    const ExrFile file(*folder / "multipart.0003.exr");
    const auto part = std::find_if(file.parts().begin(), file.parts().end(),
                                   [](const ExrPart& p) { return p.name == "forward_left"; });
    ASSERT_NE(part, file.parts().end());
    const Image stored =
        file.read_floats(int(part - file.parts().begin()), std::vector<std::string>{"forward.u"});
    const Window grid = capture.header.data_window;
    for (int y = 0; y < stored.height(); y += 7)
        for (int x = 0; x < stored.width(); x += 7)
            ASSERT_EQ(value_at(capture, "velocity_next", x + part->data_window.min_x,
                               y + part->data_window.min_y, 0)
                          .value_or(stored.at(x, y, 0)),
                      stored.at(x, y, 0));
    EXPECT_EQ(grid.width(), 880);
}

/// t09 to t12 have no pixel in the display window at all.
TEST(DisplayWindow, OfEveryExampleLeavesThePixelsInTheirOwn) {
    AFTERSHADE_REQUIRE_CAPTURE(folder, "exr-suite");
    for (const fs::path& path : exr_files(*folder / "DisplayWindow")) {
        const Capture capture = read_capture(bare_file(path), {"color"});
        const Image& color = capture.images.at("color");
        EXPECT_EQ(color.width(), capture.header.data_window.width()) << path;
        EXPECT_EQ(color.height(), capture.header.data_window.height()) << path;
        const Image stored = ExrFile(path).read_floats(0, std::vector<std::string>{"R"});
        for (int y = 0; y < stored.height(); y += 3) ASSERT_EQ(color.at(0, y, 0), stored.at(0, y, 0)) << path;
    }
}

}  // namespace
}  // namespace aftershade::test
