// Pictures and captures that were made to do harm, and inputs that once broke a reader.
#include <gtest/gtest.h>

#include <zlib.h>

#include <cstdint>
#include <ctime>
#include <functional>
#include <string>

#include "framework/base/error.h"
#include "framework/capture/capture.h"
#include "framework/capture/profile.h"
#include "framework/compare/comparison_report.h"
#include "framework/file/exr_file.h"
#include "framework/file/hdr_file.h"
#include "framework/file/png_file.h"
#include "framework/golden/golden_run.h"
#include "framework/scene/job.h"
#include "tests/fuzz/targets.h"
#include "tests/temporary_folder.h"

namespace aftershade::test {
namespace {

namespace fs = std::filesystem;

std::string big_endian(std::uint32_t value) {
    std::string bytes;
    for (int shift = 24; shift >= 0; shift -= 8) bytes += char(value >> shift & 0xff);
    return bytes;
}

std::string chunk(const std::string& type, const std::string& data) {
    const std::string named = type + data;
    const auto sum = crc32(0, reinterpret_cast<const Bytef*>(named.data()), uInt(named.size()));
    return big_endian(std::uint32_t(data.size())) + named + big_endian(std::uint32_t(sum));
}

/// RGBA of 8 bits, with this many zeros for pixels and filters.
std::string png_of_zeros(std::uint32_t width, std::uint32_t height, std::size_t zeros) {
    z_stream stream{};
    deflateInit(&stream, Z_BEST_COMPRESSION);
    std::string block(1 << 20, '\0'), packed, piece(1 << 16, '\0');
    for (std::size_t left = zeros; left > 0 || stream.avail_in > 0;) {
        if (stream.avail_in == 0) {
            stream.next_in = reinterpret_cast<Bytef*>(block.data());
            stream.avail_in = uInt(std::min(left, block.size()));
            left -= stream.avail_in;
        }
        stream.next_out = reinterpret_cast<Bytef*>(piece.data());
        stream.avail_out = uInt(piece.size());
        deflate(&stream, left == 0 && stream.avail_in == 0 ? Z_FINISH : Z_NO_FLUSH);
        packed.append(piece.data(), piece.size() - stream.avail_out);
    }
    int state = Z_OK;
    while (state != Z_STREAM_END) {
        stream.next_out = reinterpret_cast<Bytef*>(piece.data());
        stream.avail_out = uInt(piece.size());
        state = deflate(&stream, Z_FINISH);
        packed.append(piece.data(), piece.size() - stream.avail_out);
    }
    deflateEnd(&stream);
    return "\x89PNG\r\n\x1a\n" +
           chunk("IHDR", big_endian(width) + big_endian(height) + std::string("\x08\x06\0\0\0", 5)) +
           chunk("IDAT", packed) + chunk("IEND", "");
}

std::string refusal(const std::function<void()>& read) {
    try {
        read();
        return "nothing";
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::capture);
        return error.what();
    }
}

TEST(HostilePictures, ThatClaimMoreThanTheLimitAreRefusedBeforeTheyAreUnpacked) {
    const TemporaryFolder folder;
    write_text(folder / "large.png", png_of_zeros(16384, 16384, 1000));
    EXPECT_NE(
        refusal([&] {
            read_png(folder / "large.png");
        }).find("16384 x 16384 px of 4 channels take 4294967296 bytes as floats, the limit is 536870912"),
        std::string::npos);
    write_text(folder / "large.hdr", "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 16384 +X 16384\n");
    EXPECT_NE(refusal([&] { read_hdr(folder / "large.hdr"); }).find("the limit is 536870912"),
              std::string::npos);
}

TEST(HostilePictures, WhosePixelsUnpackToMoreThanTheirSizeTakesAreRefused) {
    const TemporaryFolder folder;
    constexpr std::size_t kZeros = 300'000'000;
    write_text(folder / "bomb.png", png_of_zeros(64, 64, kZeros));
    ASSERT_LT(fs::file_size(folder / "bomb.png"), 1'000'000u);
    EXPECT_NE(refusal([&] { read_png(folder / "bomb.png"); }).find("damaged: "), std::string::npos);
    write_text(folder / "sound.png", png_of_zeros(64, 64, 64 * (64 * 4 + 1)));
    EXPECT_EQ(read_png(folder / "sound.png").width(), 64);
}

TEST(HostilePictures, OfRadianceWhoseRunsEndEarlyAreRefused) {
    const TemporaryFolder folder;
    const std::string line("\x02\x02\x00\x10\x90\x80\x90\x80\x90\x80\x90\x80", 12);  // 4 runs of 16 px
    const std::string head = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 4 +X 16\n";
    const std::string sound = head + line + line + line + line;
    write_text(folder / "a.hdr", sound);
    EXPECT_EQ(read_hdr(folder / "a.hdr").at(15, 3, 0), 0.5f);
    for (std::size_t bytes = head.size(); bytes < sound.size(); ++bytes) {
        write_text(folder / "a.hdr", sound.substr(0, bytes));
        EXPECT_NE(refusal([&] { read_hdr(folder / "a.hdr"); }).find("cut off"), std::string::npos) << bytes;
    }
    std::string empty_run = sound;
    empty_run[head.size() + 4] = 0;
    write_text(folder / "a.hdr", empty_run);
    EXPECT_NE(refusal([&] { read_hdr(folder / "a.hdr"); }).find("a run of pixels is 0 px long"),
              std::string::npos);
}

/// 44 million pixels without runs, of which the file has one.
TEST(HostilePictures, OfRadianceWhosePixelsAreMissingAreRefusedBeforeTheyAreRead) {
    const TemporaryFolder folder;
    const std::string head = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n";
    for (const std::string size : {"-Y 5500 +X 8000", "-Y 7 +X 7", "-Y 9000000 +X 4"}) {
        write_text(folder / "a.hdr", head + size + "\n\xd0\xd0\xd0\xd0");
        const std::clock_t begun = std::clock();
        EXPECT_NE(refusal([&] { read_hdr(folder / "a.hdr"); }).find("cut off"), std::string::npos) << size;
        EXPECT_LT(double(std::clock() - begun) / CLOCKS_PER_SEC, 0.1) << size;
    }
    const std::string pixel("\x80\x80\x80\x81", 4);
    write_text(folder / "a.hdr", head + "-Y 1 +X 2\n" + pixel + pixel);
    EXPECT_EQ(read_hdr(folder / "a.hdr").at(1, 0, 0), 1.0f);
}

TEST(HostilePictures, OfRadianceWithoutPixelsAreRefused) {
    const TemporaryFolder folder;
    for (const std::string size : {"-Y 4 +X 0", "-Y 0 +X 4", "-Y 4 +X none"}) {
        write_text(folder / "a.hdr", "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n" + size + "\n");
        EXPECT_NE(refusal([&] { read_hdr(folder / "a.hdr"); }).find("damaged: it is "), std::string::npos)
            << size;
    }
}

TEST(Render, OfAPictureThatFillsTheMemoryIsRefusedWithTheRemedy) {
    scene::Scene scene;
    scene::Job job;
    job.folder = "out";
    job.frames = {1};
    job.width_px = job.height_px = 16384;
    Diagnostics faults;
    scene::check_job(scene, job, faults);
    ASSERT_EQ(faults.error_count(), 1);
    EXPECT_NE(faults.all()[0].message.find("the limit is 16 GiB (render fewer pixels at once"),
              std::string::npos)
        << faults.all()[0].message;
    job.width_px = 7680;
    job.height_px = 4320;
    Diagnostics none;
    scene::check_job(scene, job, none);
    EXPECT_EQ(none.error_count(), 0);
}

TEST(CsvReports, HoldNoFormulas) {
    Comparison comparison;
    comparison.reference = "=cmd|' /C calc'!A0";
    comparison.test = "@SUM(1)";
    LayerComparison layer;
    layer.label = "+1+cmd";
    comparison.layers.push_back(layer);
    layer.label = "-2";
    comparison.layers.push_back(layer);
    const std::string rows = csv_rows(comparison);
    EXPECT_TRUE(rows.starts_with("'=cmd|' /C calc'!A0,'@SUM(1),'+1+cmd,")) << rows;
    EXPECT_NE(rows.find(",-2,"), std::string::npos) << "a number stays one: " << rows;
}

TEST(Goldens, WithASidecarThatIsNotJsonDoNotPass) {
    const TemporaryFolder folder;
    const Image image(2, 2, 3);
    std::vector<ExrOutputChannel> channels;
    for (int c = 0; c < 3; ++c) channels.push_back({std::string(1, "RGB"[c]), PixelType::half, &image, c});
    ExrWriteOptions options;
    options.data_window = options.display_window = {0, 0, 1, 1};
    for (const char* name : {"a.color.0001.exr", "new.exr"}) write_exr(folder / name, channels, options);
    GoldenCase test;
    test.name = test.stem = "a";
    test.goldens = folder.path();
    RenderedImage rendered;
    rendered.name = "a.color.0001";
    rendered.file = folder / "new.exr";
    const auto judged = [&] {
        return judge_image(test, rendered, GoldenSources{"hash", "", ""}, {}, nullptr);
    };
    EXPECT_EQ(judged().verdict, Verdict::same) << "without a sidecar";
    write_text(folder / "a.color.0001.json", "hello");
    const GoldenImage result = judged();
    EXPECT_EQ(result.verdict, Verdict::file_error);
    ASSERT_FALSE(result.reasons.empty());
    EXPECT_NE(result.reasons.back().find("a.color.0001.json: is not a sidecar, not even a JSON object"),
              std::string::npos)
        << result.reasons.back();
}

TEST(Captures, WithACryptomatteThatLacksAChannelAreRefusedByName) {
    const TemporaryFolder folder;
    const Image image(2, 1, 4);
    std::vector<ExrOutputChannel> channels;
    for (const char* name : {"R", "G", "B", "A"}) channels.push_back({name, PixelType::half, &image, 0});
    for (const char* name : {"R", "B", "A"})
        channels.push_back({std::string("V.Crypto00.") + name, PixelType::float32, &image, 0});
    ExrWriteOptions options;
    options.data_window = options.display_window = {0, 0, 1, 0};
    options.attributes["cryptomatte/3ae39a5/name"] = "V.Crypto";
    options.attributes["cryptomatte/3ae39a5/manifest"] = R"({"Cube":"0"})";
    write_exr(folder / "in.exr", channels, options);
    Diagnostics faults;
    const auto profiles = read_profiles(fs::path(AFTERSHADE_SOURCE_DIR) / "profiles", faults);
    for (const std::string layer : {"", "Crypto"}) {
        Sequence sequence;
        sequence.files = FramePattern::of_file((folder / "in.exr").string());
        sequence.cryptomatte = CryptomatteChoice{layer, {"Cube"}};
        const CaptureReader reader(sequence, profiles, {});
        const std::string message = refusal([&] {
            reader.read(1, std::vector<std::string>{"mask", "object_id", "color"});
        });
        EXPECT_NE(message.find("Cryptomatte"), std::string::npos) << message;
    }
}

/// tests/fuzz/regressions/<target>/<file>: what a fuzzer found; tests/fuzz/corpus likewise, what it begins
/// with.
TEST(Fuzz, InputsOfTheTreeAreReadOrRefused) {
    const fs::path folder = fs::path(AFTERSHADE_SOURCE_DIR) / "tests/fuzz";
    int count = 0;
    for (const fuzz::Target& target : fuzz::targets())
        for (const char* kind : {"corpus", "regressions"}) {
            std::error_code absent;
            for (const auto& entry : fs::directory_iterator(folder / kind / target.name, absent)) {
                SCOPED_TRACE(entry.path().string());
                target.run(read_text(entry.path()));
                ++count;
            }
            target.run("");
        }
    EXPECT_GT(count, 20);
}

}  // namespace
}  // namespace aftershade::test
