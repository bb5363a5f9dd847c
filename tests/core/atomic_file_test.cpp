#include "framework/core/atomic_file.h"

#include <sys/stat.h>

#include <string>

#include <gtest/gtest.h>

#include "tests/temporary_folder.h"

namespace aftershade::test {
namespace {

namespace fs = std::filesystem;

TEST(TextFile, IsReadByteForByte) {
    TemporaryFolder folder;
    std::string bytes = "a\r\nb\n";
    for (int i = 0; i < 200'000; ++i) bytes += char(i % 256);  // with zeros, over many reads
    for (const std::string& text : {bytes, std::string(), std::string("\n")}) {
        write_text(folder / "file", text);
        std::error_code failure = std::make_error_code(std::errc::io_error);
        EXPECT_EQ(read_text_file(folder / "file", failure), text);
        EXPECT_FALSE(failure) << "cleared";
        EXPECT_EQ(read_text_file(folder / "file", ExitCode::usage), text);
    }
}

TEST(TextFile, IsReadToItsEndWhereTheSystemDoesNotKnowItsSize) {
    ASSERT_EQ(fs::file_size("/proc/self/cmdline"), 0u);
    EXPECT_NE(read_text_file("/proc/self/cmdline", ExitCode::usage).find("core_test"), std::string::npos);
}

TEST(TextFile, ThatCannotBeReadIsToldWithItsPathAndTheReason) {
    TemporaryFolder folder;
    write_text(folder / "file", "text");
    const std::pair<fs::path, std::string> cases[] = {{folder / "absent", "No such file or directory"},
                                                      {folder.path(), "Is a directory"},
                                                      {folder / "file/below", "Not a directory"}};
    for (const auto& [path, reason] : cases) {
        std::error_code failure;
        EXPECT_EQ(read_text_file(path, failure), "");
        EXPECT_EQ(failure.message(), reason) << path;
        try {
            read_text_file(path, ExitCode::effect);
            FAIL() << path;
        } catch (const Error& error) {
            EXPECT_EQ(error.exit_code(), ExitCode::effect);
            EXPECT_EQ(std::string(error.what()), path.string() + ": cannot be read: " + reason);
        }
    }
}

TEST(RegularFile, IsReadWholeUpToItsLimit) {
    TemporaryFolder folder;
    write_text(folder / "file", "12345");
    std::string fault = "of before";
    EXPECT_EQ(read_regular_file(folder / "file", 5, fault), "12345");
    EXPECT_EQ(fault, "");
    EXPECT_EQ(read_regular_file(folder / "file", 4, fault), "");
    EXPECT_EQ(fault, "the file has 5 bytes, the limit is 4");
}

TEST(RegularFile, IsNothingElse) {
    TemporaryFolder folder;
    const auto fault_of = [](const fs::path& path) {
        std::string fault;
        EXPECT_EQ(read_regular_file(path, 5, fault), "");
        return fault;
    };
    EXPECT_EQ(fault_of(folder / "absent"), "no such file");
    EXPECT_EQ(fault_of(folder.path()), "is not a regular file");
    ASSERT_EQ(mkfifo((folder / "pipe").c_str(), 0600), 0);
    EXPECT_EQ(fault_of(folder / "pipe"), "is not a regular file") << "opening it would wait for a writer";
}

TEST(RegularFile, IsKnownByItsFirstBytes) {
    TemporaryFolder folder;
    write_text(folder / "file", "abc");
    EXPECT_TRUE(file_begins_with(folder / "file", "ab"));
    EXPECT_TRUE(file_begins_with(folder / "file", "abc"));
    for (const char* other : {"b", "abcd"}) EXPECT_FALSE(file_begins_with(folder / "file", other)) << other;
    EXPECT_FALSE(file_begins_with(folder.path(), "a"));
    EXPECT_FALSE(file_begins_with(folder / "absent", "a"));
}

}  // namespace
}  // namespace aftershade::test
