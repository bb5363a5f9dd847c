// Files that another program replaces, or writes again, while they are read.
#include <OpenEXR/ImfRgbaFile.h>

#include <algorithm>
#include <optional>
#include <span>
#include <utility>

#include "framework/base/side_file.h"
#include "tests/file/image_files.h"

namespace aftershade::test {
namespace {

namespace fs = std::filesystem;

void write_chroma(const fs::path& path, int width, int height) {
    const std::vector<Imf::Rgba> pixels(std::size_t(width) * std::size_t(height), Imf::Rgba(0.5f, 0.25f, 1));
    Imf::RgbaOutputFile out(path.c_str(), width, height, Imf::WRITE_YC);
    out.setFrameBuffer(pixels.data(), 1, std::size_t(width));
    out.writePixels(height);
}

void write_rgb(const fs::path& path, int width, int height) {
    const Image image = pattern_image(width, height, 1);
    const ExrOutputChannel channel{"R", PixelType::float32, &image, 0};
    ExrWriteOptions options;
    options.data_window = options.display_window = {0, 0, width - 1, height - 1};
    write_exr(path, std::span(&channel, 1), options);
}

TEST(ReplacedExr, OfLuminanceAndChromaIsReadAsItWasOpened) {
    const TemporaryFolder folder;
    write_chroma(folder / "f.exr", 4, 4);
    write_chroma(folder / "wide.exr", 8192, 4);
    const Image before = ExrFile(folder / "f.exr").read_luminance_chroma(0);
    const ExrFile file(folder / "f.exr");
    fs::rename(folder / "wide.exr", folder / "f.exr");
    const Image image = file.read_luminance_chroma(0);
    ASSERT_EQ(image.width(), 4);
    EXPECT_TRUE(std::ranges::equal(image.floats(), before.floats()));
    EXPECT_EQ(ExrFile(folder / "f.exr").read_luminance_chroma(0).width(), 8192);
}

TEST(ReplacedExr, OfLuminanceAndChromaIsRefusedWhereItsBytesBecameAnotherPicture) {
    const TemporaryFolder folder;
    write_chroma(folder / "f.exr", 4, 4);
    write_chroma(folder / "wide.exr", 8192, 4);
    const ExrFile file(folder / "f.exr");
    write_text(folder / "f.exr", read_text(folder / "wide.exr"));
    EXPECT_NE(capture_error([&] { file.read_luminance_chroma(0); }).find("was changed while it was read"),
              std::string::npos);
}

TEST(ReplacedExr, OfAReportIsTheFileThatWasCheckedEvenIfALinkTakesItsPlace) {
    const TemporaryFolder folder;
    fs::create_directory(folder / "report");
    write_rgb(folder / "report/f.exr", 4, 4);
    write_rgb(folder / "secret.exr", 512, 4);
    std::string fault;
    std::optional<OpenFile> opened = open_file_below(folder / "report", "f.exr", fault);
    ASSERT_TRUE(opened) << fault;
    fs::remove(folder / "report/f.exr");
    fs::create_symlink("../secret.exr", folder / "report/f.exr");
    const ExrFile file(std::move(*opened));
    const std::vector<std::string> channels{"R"};
    EXPECT_EQ(file.path(), folder / "report/f.exr");
    EXPECT_TRUE(std::ranges::equal(file.read_floats(0, channels).floats(), pattern_image(4, 4, 1).floats()));
    EXPECT_FALSE(open_file_below(folder / "report", "f.exr", fault));
}

TEST(ReplacedExr, IsReadAsItWasOpened) {
    const TemporaryFolder folder;
    write_rgb(folder / "f.exr", 4, 4);
    write_rgb(folder / "wide.exr", 512, 4);
    const ExrFile file(folder / "f.exr");
    fs::rename(folder / "wide.exr", folder / "f.exr");
    const std::vector<std::string> channels{"R"};
    EXPECT_TRUE(std::ranges::equal(file.read_floats(0, channels).floats(), pattern_image(4, 4, 1).floats()));
}

}  // namespace
}  // namespace aftershade::test
