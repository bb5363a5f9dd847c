#include "framework/file/exr_file.h"

#include "tests/file/image_files.h"

#include <Imath/ImathMatrix.h>
#include <OpenEXR/ImfArray.h>
#include <OpenEXR/ImfBoxAttribute.h>
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfChromaticitiesAttribute.h>
#include <OpenEXR/ImfDoubleAttribute.h>
#include <OpenEXR/ImfFloatAttribute.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfInputFile.h>
#include <OpenEXR/ImfIntAttribute.h>
#include <OpenEXR/ImfMatrixAttribute.h>
#include <OpenEXR/ImfOpaqueAttribute.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfPreviewImageAttribute.h>
#include <OpenEXR/ImfRationalAttribute.h>
#include <OpenEXR/ImfStringAttribute.h>
#include <OpenEXR/ImfVecAttribute.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <algorithm>
#include <csignal>

namespace aftershade {
namespace {

namespace fs = std::filesystem;
using test::pattern_image;
using test::TemporaryFolder;

const Imath::M44f kMatrix(1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16);
const std::vector<float> kMatrixRows = {1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16};

/// Has attributes of many types, one of them unknown to the library.
void write_source(const fs::path& path) {
    const Image image = pattern_image(8, 8, 1);
    Imf::Header header(8, 8, 2.0f);
    header.channels().insert("Z", Imf::Channel(Imf::FLOAT));
    header.setName("layer");
    header.setView("left");
    header.insert("artist", Imf::StringAttribute("someone"));
    header.insert("lens", Imf::StringAttribute("50.5"));
    header.insert("take", Imf::IntAttribute(-7));
    header.insert("exposure", Imf::FloatAttribute(0.25f));
    header.insert("time", Imf::DoubleAttribute(1.0 / 3.0));
    header.insert("framesPerSecond", Imf::RationalAttribute(Imf::Rational(24000, 1001)));
    header.insert("worldToCamera", Imf::M44fAttribute(kMatrix));
    header.insert("uv", Imf::M33fAttribute(Imath::M33f(1, 2, 3, 4, 5, 6, 7, 8, 9)));
    header.insert("crop", Imf::Box2iAttribute(Imath::Box2i({1, 2}, {3, 4})));
    header.insert("offset", Imf::V2iAttribute(Imath::V2i(-3, 4)));
    header.insert("sun", Imf::V3fAttribute(Imath::V3f(0, 0.5f, 1)));
    header.insert("chromaticities",
                  Imf::ChromaticitiesAttribute(Imf::Chromaticities({0.64f, 0.33f}, {0.3f, 0.6f})));
    header.setPreviewImage(Imf::PreviewImage(2, 2));
    header.insert("secret", Imf::IntAttribute(0x01020304));
    {
        Imf::OutputFile file(path.c_str(), header);
        Imf::FrameBuffer frame;
        frame.insert("Z", Imf::Slice::Make(Imf::FLOAT, image.floats().data(), header.dataWindow()));
        file.setFrameBuffer(frame);
        file.writePixels(8);
    }
    // An attribute of a type that the library does not know: "int" renamed to one as long.
    std::string bytes = test::read_text(path);
    const std::size_t at = bytes.find(std::string("secret\0int\0", 11));
    ASSERT_NE(at, std::string::npos);
    bytes.replace(at + 7, 3, "x-y");
    test::write_text(path, bytes);
}

std::string opaque_value(const fs::path& path, const std::string& name) {
    const Imf::InputFile file(path.c_str());
    const auto* attribute = file.header().findTypedAttribute<Imf::OpaqueAttribute>(name);
    if (!attribute || std::string(attribute->typeName()) != "x-y") return "absent";
    return std::string(static_cast<const char*>(attribute->data()), std::size_t(attribute->dataSize()));
}

ExrWriteOptions window_of(const Image& image) {
    ExrWriteOptions options;
    options.data_window = options.display_window = {0, 0, image.width() - 1, image.height() - 1};
    return options;
}

void write_floats(const fs::path& path, const Image& image, const ExrWriteOptions& options) {
    const ExrOutputChannel channel{"Z", PixelType::float32, &image, 0};
    write_exr(path, {&channel, 1}, options);
}

TEST(ExrMetadata, GivesValuesOfTheKnownTypes) {
    const TemporaryFolder folder;
    write_source(folder / "a.exr");
    const ExrFile file(folder / "a.exr");
    const ExrPart& part = file.parts()[0];
    const ExrMetadata& metadata = part.metadata;
    EXPECT_EQ(part.name, "layer");
    EXPECT_EQ(part.view, "left");
    EXPECT_EQ(part.type, "scanlineimage");
    EXPECT_EQ(part.pixel_aspect, 2.0f);
    EXPECT_EQ(metadata.value("artist"), ExrValue("someone"));
    EXPECT_EQ(metadata.value("take"), ExrValue(-7));
    EXPECT_EQ(metadata.value("exposure"), ExrValue(0.25f));
    EXPECT_EQ(metadata.value("time"), ExrValue(float(1.0 / 3.0)));
    EXPECT_EQ(metadata.value("worldToCamera"), ExrValue(kMatrixRows));
    EXPECT_EQ(metadata.value("uv"), ExrValue(std::vector<float>{1, 2, 3, 4, 5, 6, 7, 8, 9}));
    EXPECT_EQ(metadata.value("crop"), ExrValue(std::vector<float>{1, 2, 3, 4}));
    EXPECT_EQ(metadata.value("offset"), ExrValue(std::vector<float>{-3, 4}));
    EXPECT_EQ(metadata.value("sun"), ExrValue(std::vector<float>{0, 0.5f, 1}));
    EXPECT_EQ(std::get<std::vector<float>>(metadata.value("chromaticities").value()).at(3), 0.6f);
    EXPECT_EQ(metadata.value("secret"), std::nullopt);
    EXPECT_EQ(metadata.value("absent"), std::nullopt);
    EXPECT_EQ(ExrMetadata().value("absent"), std::nullopt);
    EXPECT_TRUE(ExrMetadata().names().empty());
    const std::vector<std::string> names = metadata.names();
    EXPECT_NE(std::ranges::find(names, "secret"), names.end());
}

TEST(ExrMetadata, GivesNumbersAlsoFromStringsThatAreWhollyOne) {
    const TemporaryFolder folder;
    write_source(folder / "a.exr");
    const ExrFile file(folder / "a.exr");
    const ExrMetadata& metadata = file.parts()[0].metadata;
    EXPECT_EQ(metadata.number("take"), -7.0);
    EXPECT_EQ(metadata.number("lens"), 50.5);
    EXPECT_EQ(metadata.number("time"), 1.0 / 3.0);
    EXPECT_EQ(metadata.number("framesPerSecond"), 24000.0 / 1001.0);
    EXPECT_EQ(metadata.number("artist"), std::nullopt);
    EXPECT_EQ(metadata.number("sun"), std::nullopt);
    EXPECT_EQ(metadata.text("lens"), "50.5");
    EXPECT_EQ(metadata.text("take"), std::nullopt);
}

TEST(ExrWrite, CarriesEveryAttributeThatDoesNotDescribeTheOldPixels) {
    const TemporaryFolder folder;
    write_source(folder / "a.exr");
    const Image image = pattern_image(5, 5, 1);
    ExrWriteOptions options = window_of(image);
    options.compression = "piz";
    options.carry_over = ExrFile(folder / "a.exr").parts()[0].metadata;
    options.attributes = {
        {"take", 8}, {"artist", 2.5f}, {"aftershade/look", "film"}, {"sizes", std::vector<float>(5, 1.5f)}};
    write_floats(folder / "b.exr", image, options);

    const ExrFile file(folder / "b.exr");
    const ExrPart& part = file.parts()[0];
    const ExrMetadata& metadata = part.metadata;
    EXPECT_EQ(part.name, "");
    EXPECT_EQ(part.view, "left");
    EXPECT_EQ(part.compression, "piz");
    EXPECT_EQ(part.pixel_aspect, 1.0f);
    EXPECT_EQ(part.data_window, options.data_window);
    EXPECT_EQ(metadata.value("take"), ExrValue(8));
    EXPECT_EQ(metadata.value("artist"), ExrValue(2.5f));
    EXPECT_EQ(metadata.text("aftershade/look"), "film");
    EXPECT_EQ(metadata.value("sizes"), ExrValue(std::vector<float>(5, 1.5f)));
    EXPECT_EQ(metadata.value("exposure"), ExrValue(0.25f));
    EXPECT_EQ(metadata.value("worldToCamera"), ExrValue(kMatrixRows));
    EXPECT_EQ(metadata.number("time"), 1.0 / 3.0);
    EXPECT_EQ(opaque_value(folder / "b.exr", "secret"), std::string("\x04\x03\x02\x01", 4));
    const std::vector<std::string> names = metadata.names();
    for (const char* gone : {"preview", "name", "tiles", "chunkCount"}) {
        EXPECT_EQ(std::ranges::find(names, gone), names.end()) << gone;
    }
}

TEST(ExrWrite, StoresVectorsAsTheTypeOfTheirLength) {
    const TemporaryFolder folder;
    const Image image = pattern_image(2, 2, 1);
    ExrWriteOptions options = window_of(image);
    const std::vector<float> rec709 = {0.64f, 0.33f, 0.3f, 0.6f, 0.15f, 0.06f, 0.3127f, 0.329f};
    options.attributes = {{"a", std::vector<float>{1, 2}},
                          {"b", std::vector<float>{1, 2, 3}},
                          {"m", kMatrixRows},
                          {"chromaticities", rec709}};
    write_floats(folder / "a.exr", image, options);
    const Imf::InputFile file((folder / "a.exr").c_str());
    EXPECT_TRUE(file.header().findTypedAttribute<Imf::V2fAttribute>("a"));
    EXPECT_TRUE(file.header().findTypedAttribute<Imf::V3fAttribute>("b"));
    ASSERT_TRUE(file.header().findTypedAttribute<Imf::M44fAttribute>("m"));
    EXPECT_EQ(file.header().findTypedAttribute<Imf::M44fAttribute>("m")->value(), kMatrix);
    EXPECT_TRUE(file.header().findTypedAttribute<Imf::ChromaticitiesAttribute>("chromaticities"));
    EXPECT_EQ(ExrFile(folder / "a.exr").parts()[0].metadata.value("chromaticities"), ExrValue(rec709));
}

TEST(ExrWrite, SaysWhyItCannotWriteAndLeavesNothingBehind) {
    const TemporaryFolder folder;
    const Image image = pattern_image(4, 4, 1);
    const ExrWriteOptions options = window_of(image);
    fs::create_directory(folder / "folder.exr");
    const auto message = [&](const fs::path& path, const ExrWriteOptions& how) {
        return test::error_of(ErrorKind::output, [&] { write_floats(path, image, how); });
    };
    EXPECT_EQ(message(folder / "folder.exr", options),
              (folder / "folder.exr").string() + ": is a folder, a file name is expected");
    EXPECT_EQ(message(folder / "none/a.exr", options),
              (folder / "none/a.exr").string() + ": there is no folder '" + (folder / "none").string() +
                  "' (create it first)");
    ExrWriteOptions wrong = options;
    wrong.compression = "zap";
    // A newer library than 3.1 has more.
    EXPECT_TRUE(message(folder / "a.exr", wrong)
                    .starts_with((folder / "a.exr").string() +
                                 ": compression 'zap' does not exist; there are none, rle, zips, zip, "
                                 "piz, pxr24, b44, b44a, dwaa, dwab"));
    wrong = options;
    wrong.display_window = {};
    EXPECT_NE(message(folder / "a.exr", wrong).find("a.exr: cannot be written: Invalid display window"),
              std::string::npos);
    wrong = options;
    wrong.attributes[std::string(300, 'n')] = 1;
    EXPECT_NE(message(folder / "a.exr", wrong).find("300 bytes, 1 to 255 are possible"), std::string::npos);
    EXPECT_EQ(folder.file_count(), 1u);
}

/// Stands for a full disk: the kernel refuses to let any file of this process grow beyond `bytes`.
class FileSizeLimit {
public:
    explicit FileSizeLimit(rlim_t bytes) : old_handler_(std::signal(SIGXFSZ, SIG_IGN)) {
        getrlimit(RLIMIT_FSIZE, &old_);
        rlimit limit = old_;
        limit.rlim_cur = bytes;
        setrlimit(RLIMIT_FSIZE, &limit);
    }
    ~FileSizeLimit() {
        setrlimit(RLIMIT_FSIZE, &old_);
        std::signal(SIGXFSZ, old_handler_);
    }
    FileSizeLimit(const FileSizeLimit&) = delete;
    FileSizeLimit& operator=(const FileSizeLimit&) = delete;

private:
    rlimit old_ = {};
    void (*old_handler_)(int);
};

TEST(ExrWrite, KeepsTheOldFileWholeWhenTheDiskIsFullAtAnyByte) {
    const TemporaryFolder folder;
    const Image old = pattern_image(3, 3, 1);
    write_floats(folder / "a.exr", old, window_of(old));
    const std::string before = test::read_text(folder / "a.exr");
    const Image image = pattern_image(64, 64, 1);
    ExrWriteOptions options = window_of(image);
    options.compression = "none";
    write_floats(folder / "full.exr", image, options);
    const std::uintmax_t size = fs::file_size(folder / "full.exr");
    for (const std::uintmax_t bytes :
         {std::uintmax_t(0), std::uintmax_t(100), size / 2, size - 4096, size - 1}) {
        std::string message;
        {
            const FileSizeLimit limit(bytes);
            message =
                test::error_of(ErrorKind::output, [&] { write_floats(folder / "a.exr", image, options); });
        }
        EXPECT_EQ(message, (folder / "a.exr").string() + ": cannot be written: File too large") << bytes;
        EXPECT_EQ(test::read_text(folder / "a.exr"), before);
        EXPECT_EQ(folder.file_count(), 2u);
    }
    write_floats(folder / "a.exr", image, options);
    EXPECT_EQ(test::read_text(folder / "a.exr"), test::read_text(folder / "full.exr"));
}

}  // namespace
}  // namespace aftershade
