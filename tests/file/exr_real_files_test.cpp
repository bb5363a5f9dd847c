// Files of real producers, read as other tools read them.
#include <gtest/gtest.h>

#include <cstdlib>
#include <cstring>
#include <string>
#include <vector>

#include "framework/file/exr_file.h"
#include "tests/file/image_files.h"

namespace aftershade::test {
namespace {

namespace fs = std::filesystem;

TEST(ExrFile, ReadsSuzanneAsOiiotoolDoes) {
    const auto capture = find_captures("suzanne/small/gbuffer_0004.exr");
    if (!capture || std::system("command -v oiiotool >/dev/null") != 0)
        GTEST_SKIP() << "SKIPPED: no capture or no oiiotool";
    const TemporaryFolder folder;
    const std::string layer = "ViewLayer.";
    const std::vector<std::string> triples[] = {{"Combined.R", "Combined.G", "Combined.B"},
                                                {"Position.X", "Position.Y", "Position.Z"},
                                                {"Depth.Z", "Vector.X", "IndexOB.X"}};
    for (std::vector<std::string> names : triples) {
        std::string list;
        for (std::string& name : names) list += (list.empty() ? "" : ",") + (name = layer + name);
        const fs::path raw = folder / "a.tif";
        const std::string command = "oiiotool '" + capture->string() + "' --ch " + list +
                                    " -d float --compression none -o '" + raw.string() + "' >/dev/null";
        ASSERT_EQ(std::system(command.c_str()), 0);
        const std::string bytes = read_text(raw);
        const Image read = ExrFile(*capture).read_floats(0, names);
        const std::size_t size = read.floats().size_bytes();
        ASSERT_GT(bytes.size(), size);  // OpenImageIO ends an uncompressed TIFF with its pixels
        EXPECT_EQ(std::memcmp(read.floats().data(), bytes.data() + bytes.size() - size, size), 0) << list;
    }
}

TEST(ExrFile, ReadsEveryFlatPartOfTheReferenceImages) {
    int read = 0;
    for (const std::string inside : {"exr-suite", "beachball", "suzanne", "head"}) {
        const auto folder = find_captures(inside);
        if (!folder) GTEST_SKIP() << "SKIPPED: no captures";
        for (const fs::directory_entry& entry : fs::recursive_directory_iterator(*folder)) {
            if (entry.path().extension() != ".exr") continue;
            const ExrFile file(entry.path());
            for (std::size_t i = 0; i < file.parts().size(); ++i) {
                const ExrPart& part = file.parts()[i];
                std::vector<std::string> names;
                for (const ExrChannel& channel : part.channels) {
                    if (channel.x_sampling == 1 && channel.y_sampling == 1) names.push_back(channel.name);
                }
                if (part.type.starts_with("deep")) {
                    EXPECT_GT(file.read_deep(int(i), names).sample_count(), 0u) << entry.path();
                    continue;
                }
                const Image image = file.read_floats(int(i), names);
                EXPECT_EQ(image.width(), part.data_window.width()) << entry.path();
                ++read;
            }
        }
    }
    EXPECT_GT(read, 100);
}

TEST(ExrFile, ReadsTheSameBeachballFromPartsAndFromOnePart) {
    const auto parts_path = find_captures("beachball/multipart.0001.exr");
    const auto single_path = find_captures("beachball/singlepart.0001.exr");
    if (!parts_path || !single_path) GTEST_SKIP() << "SKIPPED: no captures";
    const ExrFile parts(*parts_path);
    const ExrFile single(*single_path);
    const Window all = single.parts()[0].data_window;
    int compared = 0;
    for (std::size_t i = 0; i < parts.parts().size(); ++i) {
        const ExrPart& part = parts.parts()[i];
        for (const std::string& name : channel_names(part)) {
            std::string single_name = name;
            if (part.view == "left") {
                const std::size_t dot = name.rfind('.');
                single_name = dot == std::string::npos ? "left." + name
                                                       : name.substr(0, dot) + ".left" + name.substr(dot);
            }
            if (std::ranges::find(single.parts()[0].channels, single_name, &ExrChannel::name) ==
                single.parts()[0].channels.end()) {
                continue;
            }
            const Image a = parts.read_floats(int(i), std::vector<std::string>{name});
            const Image b = single.read_floats(0, std::vector<std::string>{single_name});
            int different = 0;
            for (int y = 0; y < a.height(); ++y) {
                for (int x = 0; x < a.width(); ++x) {
                    const int file_x = x + part.data_window.min_x, file_y = y + part.data_window.min_y;
                    if (!all.contains(file_x, file_y)) continue;
                    different += a.at(x, y, 0) != b.at(file_x - all.min_x, file_y - all.min_y, 0);
                }
            }
            EXPECT_EQ(different, 0) << name << " " << part.name;
            ++compared;
        }
    }
    EXPECT_GE(compared, 8);
}

}  // namespace
}  // namespace aftershade::test
