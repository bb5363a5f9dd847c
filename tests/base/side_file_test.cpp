#include "framework/base/side_file.h"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <functional>

#include "framework/base/error.h"
#include "tests/temporary_folder.h"

namespace aftershade::test {
namespace {

namespace fs = std::filesystem;

std::string error_of(const std::function<void()>& work) {
    try {
        work();
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::output);
        return error.what();
    }
    return "";
}

TEST(FilesBelow, AreReadWithoutFollowingAnyLink) {
    const TemporaryFolder folder;
    fs::create_directories(folder / "report/images");
    write_text(folder / "secret", "secret");
    write_text(folder / "report/images/f", "text");
    fs::create_symlink("../../secret", folder / "report/images/link");
    fs::create_directory_symlink("..", folder / "report/up");
    mkfifo((folder / "report/pipe").c_str(), 0600);
    std::string fault;
    EXPECT_EQ(read_file_below(folder / "report", "images/f", 4, fault), "text");
    EXPECT_EQ(fault, "");
    EXPECT_EQ(read_file_below(folder / "report", "images/f", 3, fault), "");
    EXPECT_EQ(fault, "the file has more bytes than the limit of 3");
    for (const char* name :
         {"images/link", "up/secret", "../secret", "pipe", "images", "absent", "/etc/hosts"}) {
        EXPECT_EQ(read_file_below(folder / "report", name, 100, fault), "") << name;
        EXPECT_NE(fault, "") << name;
        EXPECT_FALSE(open_file_below(folder / "report", name, fault)) << name;
        EXPECT_NE(fault, "") << name;
    }
}

TEST(FilesBelow, AreWrittenNowhereElse) {
    const TemporaryFolder folder;
    fs::create_directories(folder / "out/real");
    fs::create_directory(folder / "other");
    write_text(folder / "secret", "secret");
    fs::create_symlink("../secret", folder / "out/link");
    fs::create_symlink("../absent", folder / "out/dangling");
    fs::create_directory_symlink("../other", folder / "out/there");
    fs::create_hard_link(folder / "secret", folder / "out/second");
    mkfifo((folder / "out/pipe").c_str(), 0600);
    for (const char* name :
         {"link", "dangling", "there/new", "there/../there/new", "second", "pipe", "real", "../secret"})
        for (const FileUse use : {FileUse::append, FileUse::update}) {
            std::string fault;
            EXPECT_FALSE(open_file_below(folder / "out", name, fault, use)) << name;
            EXPECT_NE(fault, "") << name;
        }
    EXPECT_EQ(read_text(folder / "secret"), "secret");
    EXPECT_FALSE(fs::exists(folder / "absent"));
    EXPECT_TRUE(fs::is_empty(folder / "other"));
    std::string fault;
    const auto file = open_file_below(folder / "out", "real/new", fault, FileUse::append);
    ASSERT_TRUE(file) << fault;
    EXPECT_EQ(write(file->descriptor(), "text", 4), 4);
    EXPECT_EQ(read_text(folder / "out/real/new"), "text");
}

TEST(FilesBelow, AreNamedWithTheLinkAndTheRemedy) {
    const TemporaryFolder folder;
    fs::create_directory(folder / "out");
    fs::create_symlink("../secret", folder / "out/link");
    fs::create_directory_symlink("..", folder / "out/up");
    const std::string remedy =
        "a symbolic link, which is not followed here (remove it, or put the file itself "
        "in its place)";
    EXPECT_EQ(error_of([&] { path_below(folder / "out", "link"); }),
              (folder / "out/link").string() + ": is " + remedy);
    EXPECT_EQ(error_of([&] { path_below(folder / "out", "up/file"); }),
              (folder / "out/up/file").string() + ": lies behind '" + (folder / "out/up").string() + "', " +
                  remedy);
    EXPECT_EQ(
        error_of([&] { make_folder_below(folder / "out", "up/new"); }),
        (folder / "out/up/new").string() + ": lies behind '" + (folder / "out/up").string() + "', " + remedy);
    EXPECT_FALSE(fs::exists(folder / "new"));
    EXPECT_EQ(path_below(folder / "out/up", "secret"), folder / "out/up/secret")
        << "the user named the folder";
    EXPECT_TRUE(fs::is_directory(make_folder_below(folder / "out", "a/b")));
}

}  // namespace
}  // namespace aftershade::test
