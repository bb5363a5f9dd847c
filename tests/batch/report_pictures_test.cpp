#include "framework/golden/report_pictures.h"

#include <gtest/gtest.h>

#include "framework/base/error.h"
#include "tests/temporary_folder.h"

namespace aftershade::test {
namespace {

namespace fs = std::filesystem;

class Pictures : public testing::Test {
protected:
    Pictures() { fs::create_directory(folder()); }
    fs::path folder() const { return folder_ / "images"; }
    std::set<std::string> files() const {
        std::set<std::string> names;
        for (const auto& entry : fs::directory_iterator(folder()))
            if (entry.path().filename() != ".pictures") names.insert(entry.path().filename().string());
        return names;
    }
    static void draw(ReportPictures& pictures, const std::vector<std::string>& names) {
        for (const std::string& name : names) write_text(pictures.add(name), name);
    }
    using Names = std::set<std::string>;
    TemporaryFolder folder_;
};

TEST_F(Pictures, OfEarlierRunsGoWhereARunHasEnded) {
    ReportPictures first(folder());
    draw(first, {"a.png", "b.png"});
    first.remove_old();
    EXPECT_EQ(files(), (Names{"a.png", "b.png"}));
    ReportPictures second(folder());
    draw(second, {"b.png", "b.png", "c.png"});
    EXPECT_EQ(files(), (Names{"a.png", "b.png", "c.png"})) << "the earlier report is whole until then";
    second.remove_old();
    EXPECT_EQ(files(), (Names{"b.png", "c.png"}));
    ReportPictures(folder()).remove_old();
    EXPECT_EQ(files(), Names{});
}

TEST_F(Pictures, OfARunThatWasKilledAreKnownToo) {
    {
        ReportPictures killed(folder());  // never comes to remove_old
        draw(killed, {"a.png"});
        EXPECT_EQ(killed.add("b.png"), folder() / "b.png") << "nor to write this one";
    }
    ReportPictures next(folder());
    draw(next, {"c.png"});
    next.remove_old();
    EXPECT_EQ(files(), Names{"c.png"});
}

TEST_F(Pictures, AreNoFilesOfOthers) {
    ReportPictures first(folder());
    draw(first, {"a.test.exr"});
    first.remove_old();
    for (const char* name : {"notes.txt", "shot.0001.reference.exr"}) write_text(folder() / name, name);
    write_text(folder_ / "outside", "");
    fs::create_directories(folder() / "folder/inner");
    write_text(folder() / "folder/file", "");
    fs::create_symlink(folder_ / "outside", folder() / "link");
    // As if somebody had changed the list.
    write_text(folder() / ".pictures", "a.test.exr\n../outside\n..\n.\n\nfolder\nfolder/file\nlink\n" +
                                           (folder_ / "outside").string() + "\n");
    ReportPictures(folder()).remove_old();
    EXPECT_EQ(files(), (Names{"folder", "link", "notes.txt", "shot.0001.reference.exr"}));
    EXPECT_TRUE(fs::exists(folder_ / "outside"));
    EXPECT_TRUE(fs::exists(folder() / "folder/file"));
}

TEST_F(Pictures, TellAFolderThatCannotBeMade) {
    try {
        ReportPictures(folder_ / "nowhere/images");
        FAIL();
    } catch (const Error& error) {
        EXPECT_NE(std::string(error.what()).find("nowhere/images"), std::string::npos) << error.what();
    }
}

}  // namespace
}  // namespace aftershade::test
