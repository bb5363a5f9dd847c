#include "framework/base/path_bounds.h"

#include <gtest/gtest.h>

#include <cstdlib>

#include "tests/temporary_folder.h"

namespace aftershade::test {
namespace {

namespace fs = std::filesystem;

TEST(PathBounds, HoldWithLinksFollowed) {
    const TemporaryFolder folder;
    fs::create_directories(folder / "own/below");
    fs::create_directory(folder / "ownership");
    write_text(folder / "secret", "");
    fs::create_symlink("../secret", folder / "own/link");
    fs::create_symlink("below", folder / "own/inside");
    const fs::path own = folder / "own";
    for (const char* name : {"own/f", "own/below/f", "own/inside/f", "own/below/../f", "own"})
        EXPECT_EQ(out_of_bounds(folder / name, own), "") << name;
    for (const char* name : {"own/link", "own/../secret", "ownership/f"})
        EXPECT_TRUE(out_of_bounds(folder / name, own).starts_with("leads out of the folder '" + own.string()))
            << name;
    EXPECT_FALSE(out_of_bounds("/etc/passwd", own).empty());
    EXPECT_EQ(out_of_bounds(fs::current_path() / "f", ""), "") << "the working folder";
}

TEST(PathBounds, KnowNamesThatTellWhatIsElsewhere) {
    const TemporaryFolder folder, other;
    fs::create_directories(folder / "own/below");
    fs::create_directory(other / "there");
    fs::create_directory_symlink(other.path(), folder / "own/link");
    const fs::path own = folder / "own";
    for (const fs::path& name : {own / "f", own / "below/../f", own / "../own/f", own / "../../x/f",
                                 own / "absent/../f", folder / "f", other / "f"})
        EXPECT_FALSE(has_detour(name, {own})) << name;
    for (const char* name : {"there", "absent"}) {
        EXPECT_TRUE(has_detour(other / name / ".." / ".." / "f", {own})) << name;
        EXPECT_TRUE(has_detour(own / "link" / name / ".." / "f", {own})) << name;
        EXPECT_FALSE(has_detour(other / name / ".." / "f", {own, other.path()})) << name;
    }
}

TEST(PathBounds, HoldAFileToItsOwnFolderWhereverThatLeads) {
    const TemporaryFolder folder;
    fs::create_directories(folder / "real/below");
    fs::create_directory(folder / "links");
    fs::create_directory_symlink("../real", folder / "links/own");
    write_text(folder / "real/file", "");
    write_text(folder / "secret", "");
    fs::create_symlink("../secret", folder / "real/link");
    fs::create_symlink("file", folder / "real/same");
    const fs::path own = folder / "links/own";
    for (const char* name : {"file", "same", "below", "absent", "."})
        EXPECT_EQ(out_of_bounds(own / name, own), "") << name;
    for (const char* name : {"link", ".."}) EXPECT_NE(out_of_bounds(own / name, own), "") << name;
}

TEST(PathBounds, AreWidenedByFoldersThatTheUserAllows) {
    const TemporaryFolder folder;
    fs::create_directory(folder / "own");
    EXPECT_NE(out_of_bounds(folder / "shared/f", folder / "own"), "");
    allow_folders({(folder / "elsewhere").string(), (folder / "shared").string()});
    EXPECT_EQ(out_of_bounds(folder / "shared/f", folder / "own"), "");
    EXPECT_NE(out_of_bounds(folder / "other/f", folder / "own"), "");
    unsetenv("AFTERSHADE_ALLOW_PATH");
}

}  // namespace
}  // namespace aftershade::test
