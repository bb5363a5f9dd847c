// The pictures of reports that are run into more than once.
#include <gtest/gtest.h>

#include <filesystem>
#include <set>
#include <thread>

#include "tests/cli/golden_suite.h"

namespace aftershade::test {
namespace {

namespace fs = std::filesystem;

using GoldenPicturesOfReports = GoldenCommand;

TEST_F(GoldenPicturesOfReports, AreOnlyThoseOfTheLastRun) {
    approve();
    const auto pictures = [&] {
        std::set<std::string> names;
        for (const auto& entry : fs::directory_iterator(folder_ / "report/images"))
            if (entry.path().filename() != ".pictures")
                names.insert("images/" + entry.path().filename().string());
        return names;
    };
    const auto of_report = [&] {
        std::set<std::string> names;
        const Json document = Json::parse(read_text(folder_ / "report/report.json"));
        for (const Json& test : document["cases"])
            for (const Json& image : test["images"])
                for (const Json& picture : image["pictures"])
                    if (picture.is_string()) names.insert(picture.get<std::string>());
        return names;
    };
    EXPECT_EQ(run({"--report", "report"}).exit_code, 0);
    EXPECT_EQ(pictures().size(), 3u * 4) << "reference and test of three images";
    EXPECT_EQ(pictures(), of_report());
    const std::set<std::string> foreign = {"images/notes.txt", "images/shot.0001.reference.exr"};
    for (const std::string& name : foreign) write_text(folder_ / ("report/" + name), name);
    write_text(folder_ / "report/notes.txt", "mine");
    EXPECT_EQ(run({"--report", "report", "--filter", "corner"}).exit_code, 0);
    std::set<std::string> expected = of_report();
    EXPECT_EQ(expected.size(), 4u);
    expected.insert(foreign.begin(), foreign.end());
    EXPECT_EQ(pictures(), expected);
    EXPECT_EQ(read_text(folder_ / "report/notes.txt"), "mine");
}

TEST_F(GoldenPicturesOfReports, OfARunThatWasKilledGoToo) {
    approve();
    const auto lens_pictures = [&] {
        int count = 0;
        std::error_code absent;
        for (const auto& entry : fs::directory_iterator(folder_ / "report/images", absent))
            count += entry.path().filename().string().starts_with("lens.");
        return count;
    };
    {
        Command killed(aftershade_words({"golden", "run", "golden.json", "--report", "report"}),
                       folder_.path());
        for (int waited = 0; waited < 10'000 && lens_pictures() == 0; ++waited)
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
        killed.send(SIGKILL);
        killed.wait();
    }
    ASSERT_GT(lens_pictures(), 0);
    EXPECT_EQ(run({"--report", "report", "--filter", "corner"}).exit_code, 0);
    EXPECT_EQ(lens_pictures(), 0);
}

TEST_F(GoldenPicturesOfReports, AreTheFilesAloneWhereNoPixelIsInBoth) {
    approve();
    const fs::path golden_file = image("corner.color.0001");
    const std::vector<std::string> names{"R", "G", "B", "A"};
    const Image pixels = ExrFile(golden_file).read_floats(0, names);
    std::vector<ExrOutputChannel> channels;
    for (int c = 0; c < 4; ++c) channels.push_back({names[std::size_t(c)], PixelType::half, &pixels, c});
    ExrWriteOptions elsewhere;
    elsewhere.data_window = {1000, 1000, 1000 + pixels.width() - 1, 1000 + pixels.height() - 1};
    elsewhere.display_window = {0, 0, pixels.width() - 1, pixels.height() - 1};
    write_exr(golden_file, channels, elsewhere);
    EXPECT_EQ(run({"--filter", "corner", "--report", "report"}).exit_code, 3);
    const Json document = Json::parse(read_text(folder_ / "report/report.json"));
    const Json& pictures = document["cases"][0]["images"][0]["pictures"];
    for (const char* key : {"reference_exr", "test_exr"})
        EXPECT_TRUE(fs::exists(folder_ / "report" / pictures[key].get<std::string>())) << key;
    for (const char* key : {"difference", "heat_map", "side_by_side"})
        EXPECT_TRUE(pictures[key].is_null()) << key;
    EXPECT_TRUE(fs::exists(folder_ / "report/index.html"));
}

TEST_F(GoldenPicturesOfReports, ArePutUnderNoFiguresOfAnEarlierRun) {
    approve();
    EXPECT_EQ(run({"--report", "report"}).exit_code, 0);
    ASSERT_TRUE(fs::exists(folder_ / "report/index.html"));
    Command killed(aftershade_words({"golden", "run", "golden.json", "--report", "report"}), folder_.path());
    for (int waited = 0; waited < 10'000 && fs::exists(folder_ / "report/index.html"); ++waited)
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    killed.send(SIGKILL);
    killed.wait();
    EXPECT_FALSE(fs::exists(folder_ / "report/report.json"));
    EXPECT_FALSE(fs::exists(folder_ / "report/index.html"));
}

}  // namespace
}  // namespace aftershade::test
