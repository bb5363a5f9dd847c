#include "framework/capture/cryptomatte.h"

#include <bit>

#include <gtest/gtest.h>

#include "framework/capture/capture.h"
#include "tests/file/image_files.h"

namespace aftershade::test {
namespace {

/// The example manifest of the Cryptomatte specification 1.2.0: {"bunny":"13851a76","default":"42c9679f"}.
TEST(Cryptomatte, HashesNamesAsItsSpecificationDoes) {
    EXPECT_EQ(cryptomatte_hash("bunny"), 0x13851a76u);
    EXPECT_EQ(cryptomatte_hash("default"), 0x42c9679fu);
}

TEST(Cryptomatte, NeverHashesToAnInfiniteOrDenormalFloat) {
    for (int i = 0; i < 200000; ++i) {
        const std::uint32_t exponent = cryptomatte_hash("object" + std::to_string(i)) >> 23 & 0xff;
        ASSERT_TRUE(exponent != 0 && exponent != 0xff) << i;
    }
}

TEST(IdRanges, RiseWithAGapBetweenAnyTwo) {
    using Ranges = std::vector<IdRange>;
    const auto of = [](const std::vector<TableKey>& keys) { return id_ranges(keys); };
    EXPECT_EQ(of({}), Ranges{});
    EXPECT_EQ(of({{7, 9, ""}, {1, 3, ""}}), (Ranges{{1, 3}, {7, 9}}));
    EXPECT_EQ(of({{5, 5, ""}, {4, 4, ""}, {6, 6, ""}}), (Ranges{{4, 6}})) << "ids that follow one another";
    EXPECT_EQ(of({{1, 9, ""}, {3, 4, ""}, {9, 12, ""}}), (Ranges{{1, 12}}));
    EXPECT_EQ(of({{4294967295u, 4294967295u, ""}, {0, 4294967294u, ""}}), (Ranges{{0, 4294967295u}}));
    EXPECT_EQ(of({{0, 0, "bunny"}, {1, 1, ""}}), (Ranges{{1, 1}, {0x13851a76u, 0x13851a76u}}));
}

TEST(IdRanges, HaveTheirEnds) {
    const std::vector<IdRange> ranges = {{1, 3}, {7, 7}, {9, 4294967295u}};
    for (const std::uint32_t id : {1u, 2u, 3u, 7u, 9u, 4294967295u}) EXPECT_TRUE(contains(ranges, id)) << id;
    for (const std::uint32_t id : {0u, 4u, 6u, 8u}) EXPECT_FALSE(contains(ranges, id)) << id;
    EXPECT_FALSE(contains({}, 0));
}

struct Coverage {
    std::string object;
    float amount = 0;
};

/// One pixel with up to four covering objects, under the names that Blender gives.
std::filesystem::path write_matte(const TemporaryFolder& folder, const std::vector<Coverage>& objects,
                                  PixelType type, const std::string& compression = "zip",
                                  const std::vector<std::string>& components = {"R", "G", "B", "A"}) {
    Image image(2, 1, 8);
    for (std::size_t i = 0; i < objects.size(); ++i) {
        image.at(0, 0, int(2 * i)) = std::bit_cast<float>(cryptomatte_hash(objects[i].object));
        image.at(0, 0, int(2 * i + 1)) = objects[i].amount;
    }
    const Image color(2, 1, 3);
    std::vector<ExrOutputChannel> channels;
    for (int c = 0; c < 3; ++c) channels.push_back({std::string(1, "RGB"[c]), PixelType::half, &color, c});
    for (int c = 0; c < 8; ++c)
        channels.push_back(
            {"ViewLayer.CryptoObject0" + std::to_string(c / 4) + "." + components[std::size_t(c % 4)], type,
             &image, c});
    ExrWriteOptions options;
    options.data_window = options.display_window = {0, 0, 1, 0};
    options.compression = compression;
    options.attributes["cryptomatte/3ae39a5/name"] = "ViewLayer.CryptoObject";
    options.attributes["cryptomatte/3ae39a5/manifest"] =
        R"({"Suzanne":"0","Cube":"0","Ball":"0","Pole":"0"})";
    const auto path = folder / "matte.exr";
    write_exr(path, channels, options);
    return path;
}

Capture read_with(const std::filesystem::path& path, std::vector<std::string> mask) {
    Sequence sequence;
    sequence.files = FramePattern(path.string());
    sequence.cryptomatte = CryptomatteChoice{"CryptoObject", std::move(mask)};
    Diagnostics diagnostics;
    const CaptureReader reader(sequence, read_profiles(AFTERSHADE_SOURCE_DIR "/profiles", diagnostics), {});
    return reader.read(1, std::vector<std::string>{"mask", "object_id", "color"});
}

TEST(Cryptomatte, SumsTheCoverageOfNamedObjectsOverAllRanks) {
    const TemporaryFolder folder;
    const auto path =
        write_matte(folder, {{"Cube", 0.5f}, {"Suzanne", 0.25f}, {"Ball", 0.125f}, {"Pole", 0.0625f}},
                    PixelType::float32);
    EXPECT_FLOAT_EQ(read_with(path, {"Suzanne", "Pole"}).images.at("mask").at(0, 0, 0), 0.3125f);
    EXPECT_FLOAT_EQ(read_with(path, {"Cube"}).images.at("mask").at(1, 0, 0), 0);
    EXPECT_EQ(read_with(path, {"Cube"}).images.at("object_id").uint_at(0, 0, 0), cryptomatte_hash("Cube"));
}

// Blender's, and those of Clarisse and of what Nuke writes again.
TEST(Cryptomatte, IsReadWhicheverWayItsComponentsAreSpelled) {
    for (const std::vector<std::string>& components :
         {std::vector<std::string>{"r", "g", "b", "a"}, {"red", "green", "blue", "alpha"}}) {
        const TemporaryFolder folder;
        const auto path = write_matte(folder, {{"Cube", 0.5f}, {"Suzanne", 0.25f}, {"Ball", 0.125f}},
                                      PixelType::float32, "zip", components);
        EXPECT_FLOAT_EQ(read_with(path, {"Suzanne", "Ball"}).images.at("mask").at(0, 0, 0), 0.375f);
    }
}

CaptureReader reader_of(Sequence& sequence, const std::filesystem::path& path) {
    sequence.files = FramePattern(path.string());
    Diagnostics diagnostics;
    return CaptureReader(sequence, read_profiles(AFTERSHADE_SOURCE_DIR "/profiles", diagnostics), {});
}

TEST(Coverage, OfObjectsThatALookNamesNeedsNothingInTheCapture) {
    const TemporaryFolder folder;
    const auto path = write_matte(folder, {{"Cube", 0.5f}, {"Suzanne", 0.25f}}, PixelType::float32);
    Sequence sequence;
    const RoleId role = RoleId::coverage(std::vector<TableKey>{{0, 0, "Suzanne"}, {0, 0, "Pole"}});
    EXPECT_EQ(find_role(role)->kind, RoleKind::coverage);
    const Capture capture = reader_of(sequence, path).read(1, std::vector<RoleId>{role});
    EXPECT_FLOAT_EQ(capture.images.at(role).at(0, 0, 0), 0.25f);
    EXPECT_FLOAT_EQ(capture.images.at(role).at(1, 0, 0), 0);
}

TEST(Coverage, OfAnObjectThatTheManifestLacksIsRefused) {
    const TemporaryFolder folder;
    Sequence sequence;
    const CaptureReader reader = reader_of(sequence, write_matte(folder, {{"Cube", 1}}, PixelType::float32));
    const std::vector<RoleId> roles = {RoleId::coverage(std::vector<TableKey>{{0, 0, "Cub"}})};
    const std::string message = capture_error([&] { reader.read(1, roles); });
    EXPECT_NE(message.find("has no object 'Cub'; did you mean 'Cube'?"), std::string::npos) << message;
}

TEST(Coverage, IsRefusedWhereObjectsHaveNumbersAndNoNames) {
    const TemporaryFolder folder;
    const Image image = [] {
        Image values(2, 1, 1);
        values.at(0, 0, 0) = 7;
        return values;
    }();
    std::vector<ExrOutputChannel> channels;
    for (const char* name : {"V.Combined.R", "V.Combined.G", "V.Combined.B", "V.IndexOB.X"})
        channels.push_back({name, PixelType::float32, &image, 0});
    ExrWriteOptions options;
    options.data_window = options.display_window = {0, 0, 1, 0};
    write_exr(folder / "ids.exr", channels, options);
    Sequence sequence;
    const CaptureReader reader = reader_of(sequence, folder / "ids.exr");
    const std::vector<RoleId> roles = {RoleId::coverage(std::vector<TableKey>{{0, 0, "Suzanne"}})};
    const std::string message = capture_error([&] { reader.read(1, roles); });
    EXPECT_NE(message.find("names the object 'Suzanne', but object_id is read from V.IndexOB.X, which holds "
                           "numbers, and the file has no Cryptomatte (render a Cryptomatte of objects"),
              std::string::npos)
        << message;
    const std::vector<RoleId> by_number = {RoleId::coverage(std::vector<TableKey>{{7, 7, ""}})};
    EXPECT_EQ(reader.read(1, by_number).images.at(by_number[0]).at(0, 0, 0), 1);
}

/// Two pixels: Cube over number 7, and number 9 alone.
std::filesystem::path write_matte_and_numbers(const TemporaryFolder& folder, float second_number) {
    const auto path = folder / "both.exr";
    Image image(2, 1, 5);
    image.at(0, 0, 0) = std::bit_cast<float>(cryptomatte_hash("Cube"));
    image.at(0, 0, 1) = 0.75f;
    image.at(0, 0, 4) = 7;
    image.at(1, 0, 4) = second_number;
    std::vector<ExrOutputChannel> channels;
    for (const char* name : {"V.Combined.R", "V.Combined.G", "V.Combined.B"})
        channels.push_back({name, PixelType::half, &image, 3});
    for (int c = 0; c < 4; ++c)
        channels.push_back(
            {std::string("V.CryptoObject00.") + "RGBA"[c], PixelType::float32, &image, c < 2 ? c : 3});
    channels.push_back({"V.IndexOB.X", PixelType::float32, &image, 4});
    ExrWriteOptions options;
    options.data_window = options.display_window = {0, 0, 1, 0};
    options.attributes["cryptomatte/3ae39a5/name"] = "V.CryptoObject";
    options.attributes["cryptomatte/3ae39a5/manifest"] = R"({"Cube":"0"})";
    write_exr(path, channels, options);
    return path;
}

TEST(ObjectIds, OfALookMayBeNumbersAndNames) {
    const TemporaryFolder folder;
    Sequence sequence;
    const CaptureReader reader = reader_of(sequence, write_matte_and_numbers(folder, 9));
    sequence.object_names = {"Cube"};
    const auto role_of = [](std::vector<TableKey> keys) { return RoleId::coverage(keys); };
    const std::vector<RoleId> roles = {role_of({{0, 0, "Cube"}}), role_of({{7, 7, ""}}),
                                       role_of({{9, 9, ""}, {0, 0, "Cube"}}), "object_id"};
    const Capture capture = reader.read(1, roles);
    const auto coverage = [&](int role, int x) {
        return capture.images.at(roles[std::size_t(role)]).at(x, 0, 0);
    };
    EXPECT_EQ(coverage(0, 0), 0.75f);
    EXPECT_EQ(coverage(0, 1), 0);
    EXPECT_EQ(coverage(1, 0), 1);
    EXPECT_EQ(coverage(1, 1), 0);
    EXPECT_EQ(coverage(2, 0), 0.75f);
    EXPECT_EQ(coverage(2, 1), 1);
    EXPECT_EQ(capture.images.at("object_id").uint_at(0, 0, 0), cryptomatte_hash("Cube"));
    EXPECT_EQ(capture.images.at("object_id").uint_at(1, 0, 0), 9u);
    EXPECT_EQ(capture.header.notes, std::vector<std::string>{});
}

TEST(ObjectIds, ByNameDoWithoutNumbersThatWereAveraged) {
    const TemporaryFolder folder;
    Sequence sequence;
    const CaptureReader reader = reader_of(sequence, write_matte_and_numbers(folder, 8.5f));
    sequence.object_names = {"Cube"};
    const Capture capture = reader.read(1, std::vector<std::string>{"object_id"});
    EXPECT_EQ(capture.images.at("object_id").uint_at(0, 0, 0), cryptomatte_hash("Cube"));
}

TEST(Cryptomatte, TellsWhatItsObjectsCover) {
    const TemporaryFolder folder;
    const auto path = write_matte(folder, {{"Cube", 0.5f}, {"Suzanne", 0.25f}}, PixelType::float32);
    Sequence sequence;
    const CaptureReader reader = reader_of(sequence, path);
    const auto objects = reader.cryptomatte_coverage(1, reader.cryptomatte_name(1, ""));
    ASSERT_EQ(objects.size(), 4u);
    EXPECT_EQ(objects[0].name, "Cube");
    EXPECT_DOUBLE_EQ(objects[0].coverage_px, 0.5);
    EXPECT_EQ(objects[1].name, "Suzanne");
    EXPECT_DOUBLE_EQ(objects[3].coverage_px, 0);
}

// "files": {"object_id": "crypto.exr"} beside "frames" of the beauty.
TEST(Cryptomatte, InAFileOfItsOwnGivesTheIdsOfObjects) {
    const TemporaryFolder folder;
    const auto matte = write_matte(folder, {{"Cube", 1}}, PixelType::float32);
    const Image image(2, 1, 3);
    std::vector<ExrOutputChannel> channels;
    for (int c = 0; c < 3; ++c) channels.push_back({std::string(1, "RGB"[c]), PixelType::half, &image, c});
    ExrWriteOptions options;
    options.data_window = options.display_window = {0, 0, 1, 0};
    write_exr(folder / "beauty.exr", channels, options);
    Sequence sequence;
    sequence.role_files.emplace("object_id", FramePattern(matte.string()));
    const Capture capture =
        reader_of(sequence, folder / "beauty.exr").read(1, std::vector<std::string>{"object_id"});
    EXPECT_EQ(capture.images.at("object_id").uint_at(0, 0, 0), cryptomatte_hash("Cube"));
}

TEST(Cryptomatte, KnowsTheObjectsOfItsManifest) {
    const TemporaryFolder folder;
    const auto path = write_matte(folder, {{"Cube", 1}}, PixelType::float32);
    const std::string message = capture_error([&] { read_with(path, {"Suzane"}); });
    EXPECT_NE(message.find("did you mean 'Suzanne'?"), std::string::npos) << message;
}

/// A matte of one pixel that the first object covers, with a manifest in its header or beside it.
std::filesystem::path write_manifest(const TemporaryFolder& folder, const std::string& key,
                                     const std::string& manifest, std::uint32_t id,
                                     const std::string& name = "uCryptoObject",
                                     const std::string& channel_name = "uCryptoObject") {
    Image image(1, 1, 4);
    image.at(0, 0, 0) = std::bit_cast<float>(id);
    image.at(0, 0, 1) = 0.5f;
    const Image color(1, 1, 3);
    std::vector<ExrOutputChannel> channels;
    for (int c = 0; c < 3; ++c) channels.push_back({std::string(1, "RGB"[c]), PixelType::half, &color, c});
    for (int c = 0; c < 4; ++c)
        channels.push_back({channel_name + "00." + "RGBA"[c], PixelType::float32, &image, c});
    ExrWriteOptions options;
    options.data_window = options.display_window = {0, 0, 0, 0};
    options.attributes["cryptomatte/1234567/name"] = name;
    options.attributes["cryptomatte/1234567/" + key] = manifest;
    write_exr(folder / "matte.exr", channels, options);
    return folder / "matte.exr";
}

RoleId coverage_of(const std::string& object) {
    const std::vector<TableKey> keys = {{0, 0, object}};
    return RoleId::coverage(keys);
}

Capture read_object(const std::filesystem::path& path, const std::string& object) {
    Sequence sequence;
    sequence.object_names = {object};
    return reader_of(sequence, path).read(1, std::vector<RoleId>{"object_id", coverage_of(object)});
}

TEST(CryptomatteManifest, MayLieBesideTheFile) {
    const TemporaryFolder folder;
    write_text(folder / "shot.json", R"({"hero": "01020304", "sword": "0a0b0c0d"})");
    const auto path = write_manifest(folder, "manif_file", "shot.json", 0x01020304);
    const std::string message = capture_error([&] { read_object(path, "heroo"); });
    EXPECT_NE(message.find("did you mean 'hero'?"), std::string::npos) << message;
}

TEST(CryptomatteManifest, OutsideTheFolderOfTheFileIsNotRead) {
    const TemporaryFolder folder;
    std::filesystem::create_directory(folder / "in");
    write_text(folder / "shot.json", R"({"hero": "01020304"})");
    const auto path = write_manifest(folder, "manif_file", "../shot.json", 0x01020304);
    std::filesystem::rename(path, folder / "in" / "matte.exr");
    Sequence sequence;
    EXPECT_EQ(reader_of(sequence, folder / "in" / "matte.exr").cryptomattes(1).at(0).object_names,
              std::vector<std::string>{});
}

// Renderers that cut or mangle names hash what they had before.
TEST(CryptomatteManifest, SaysTheIdsOfItsObjects) {
    const TemporaryFolder folder;
    ASSERT_NE(cryptomatte_hash("hero"), 0x01020304u);
    const auto path = write_manifest(folder, "manifest", R"({"hero": "01020304"})", 0x01020304);
    const Capture capture = read_object(path, "hero");
    EXPECT_FLOAT_EQ(capture.images.at(coverage_of("hero")).at(0, 0, 0), 0.5f);
    EXPECT_EQ(capture.images.at("object_id").uint_at(0, 0, 0), cryptomatte_hash("hero"));
    Sequence sequence;
    const auto covered = reader_of(sequence, path).cryptomatte_coverage(1, "");
    ASSERT_EQ(covered.size(), 1u);
    EXPECT_EQ(covered[0].name, "hero");
}

// As Nuke writes Blender's again, whose attribute keeps the name.
TEST(Cryptomatte, IsFoundWhereMarksInTheNamesOfItsChannelsWereChanged) {
    const TemporaryFolder folder;
    const auto path = write_manifest(folder, "manifest", R"({"hero": "01020304"})", 0x01020304,
                                     "View Layer.CryptoObject", "View_Layer_CryptoObject");
    EXPECT_FLOAT_EQ(read_object(path, "hero").images.at(coverage_of("hero")).at(0, 0, 0), 0.5f);
}

TEST(Cryptomatte, OfAnotherKindThatHasTheNameIsNamed) {
    const TemporaryFolder folder;
    const Image image(1, 1, 4);
    std::vector<ExrOutputChannel> channels;
    for (const std::string head : {"", "CryptoObject00.", "CryptoMaterial00."})
        for (int c = 0; c < 4; ++c) channels.push_back({head + "RGBA"[c], PixelType::float32, &image, c});
    ExrWriteOptions options;
    options.data_window = options.display_window = {0, 0, 0, 0};
    options.attributes["cryptomatte/1/name"] = std::string("CryptoMaterial");
    options.attributes["cryptomatte/1/manifest"] = std::string(R"({"skin": "01020304"})");
    options.attributes["cryptomatte/2/name"] = std::string("CryptoObject");
    options.attributes["cryptomatte/2/manifest"] = std::string(R"({"head": "01020305"})");
    write_exr(folder / "matte.exr", channels, options);
    Sequence sequence;
    sequence.cryptomatte = CryptomatteChoice{"CryptoObject", {"skin"}};
    const CaptureReader reader = reader_of(sequence, folder / "matte.exr");
    const std::string message = capture_error([&] { reader.read(1, std::vector<std::string>{"mask"}); });
    EXPECT_NE(message.find("CryptoObject has no object 'skin'; 'skin' is in the Cryptomatte CryptoMaterial"),
              std::string::npos)
        << message;
    EXPECT_EQ(message.find("did you mean"), std::string::npos) << message;
}

/// dwaa and dwab change what is called R, G or B; b44 and b44a only halfs.
TEST(Cryptomatte, ReadsIdsThatALossyCompressionHasKept) {
    const TemporaryFolder folder;
    const std::vector<std::string> lower = {"r", "g", "b", "a"}, upper = {"R", "G", "B", "A"};
    for (const auto& [compression, components] : {std::pair{"dwaa", lower}, std::pair{"dwab", lower},
                                                  std::pair{"b44", upper}, std::pair{"b44a", lower}}) {
        const auto matte =
            write_matte(folder, {{"Cube", 0.75f}}, PixelType::float32, compression, components);
        EXPECT_EQ(read_with(matte, {"Cube"}).images.at("mask").floats()[0], 0.75f) << compression;
    }
}

TEST(Cryptomatte, RefusesIdsThatStorageHasDestroyed) {
    const TemporaryFolder folder;
    EXPECT_NE(capture_error([&] {
                  read_with(write_matte(folder, {{"Cube", 1}}, PixelType::half), {"Cube"});
              }).find("half"),
              std::string::npos);
    const auto packed = write_matte(folder, {{"Cube", 1}}, PixelType::float32, "pxr24", {"r", "g", "b", "a"});
    EXPECT_NE(capture_error([&] { read_with(packed, {"Cube"}); }).find("pxr24"), std::string::npos);
    const auto lossy = write_matte(folder, {{"Cube", 1}}, PixelType::float32, "dwaa");
    EXPECT_NE(capture_error([&] { read_with(lossy, {"Cube"}); }).find("dwaa"), std::string::npos);
}

}  // namespace
}  // namespace aftershade::test
