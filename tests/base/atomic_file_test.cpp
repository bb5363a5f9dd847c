#include "framework/base/atomic_file.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <string>
#include <vector>

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
        EXPECT_EQ(read_text_file(folder / "file", ErrorKind::usage), text);
    }
}

TEST(TextFile, IsReadToItsEndWhereTheSystemDoesNotKnowItsSize) {
    ASSERT_EQ(fs::file_size("/proc/self/cmdline"), 0u);
    EXPECT_NE(read_text_file("/proc/self/cmdline", ErrorKind::usage).find("base_test"), std::string::npos);
}

TEST(TextFile, ThatCannotBeReadIsToldWithItsPathAndTheReason) {
    TemporaryFolder folder;
    write_text(folder / "file", "text");
    const std::pair<fs::path, std::string> cases[] = {
        {folder / "absent", "no such file"},
        {folder.path(), "is not a regular file"},
        {"/dev/zero", "is not a regular file"},
        {folder / "file/below", "cannot be read: Not a directory"}};
    for (const auto& [path, reason] : cases) {
        try {
            read_text_file(path, ErrorKind::effect);
            FAIL() << path;
        } catch (const Error& error) {
            EXPECT_EQ(error.kind(), ErrorKind::effect);
            EXPECT_EQ(std::string(error.what()), path.string() + ": " + reason);
        }
    }
}

TEST(TextFile, IsReplacedWhereItHoldsWhatItHeldAlone) {
    TemporaryFolder folder;
    EXPECT_TRUE(replace_text_file(folder / "file", "", "one")) << "it was absent";
    EXPECT_FALSE(replace_text_file(folder / "file", "other", "two"));
    EXPECT_EQ(read_text_file(folder / "file", ErrorKind::usage), "one");
    EXPECT_TRUE(replace_text_file(folder / "file", "one", "two"));
    EXPECT_EQ(read_text_file(folder / "file", ErrorKind::usage), "two");
    ASSERT_EQ(mkfifo((folder / "pipe").c_str(), 0600), 0);
    EXPECT_THROW(replace_text_file(folder / "pipe", "", "two"), Error);
    const int holder = open(folder.path().c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    flock(holder, LOCK_EX);
    EXPECT_THROW(replace_text_file(folder / "file", "two", "three"), Error) << "and does not wait for ever";
    close(holder);
    EXPECT_EQ(read_text_file(folder / "file", ErrorKind::usage), "two");
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

/// A process that ran, and is gone.
pid_t dead_process() {
    const pid_t child = fork();
    if (child == 0) _exit(0);
    waitpid(child, nullptr, 0);
    return child;
}

/// The name of a temporary file of this host with another process in it.
fs::path temporary_of(const fs::path& file, pid_t process) {
    const std::string own = AtomicFile(file).temporary_path().string();
    const std::string mark = "-" + std::to_string(getpid()) + "-";
    std::string other = own;
    return other.replace(own.rfind(mark), mark.size(), "-" + std::to_string(process) + "-");
}

TEST(StaleTemporaries, GoWhenTheirProcessIsGone) {
    const TemporaryFolder folder;
    const fs::path stale = temporary_of(folder / "out.exr", dead_process());
    write_text(stale, "half");
    write_text(folder / "out.exr", "whole");
    EXPECT_EQ(remove_stale_temporaries(folder.path()), std::vector<fs::path>{stale});
    EXPECT_FALSE(fs::exists(stale));
    EXPECT_EQ(read_text(folder / "out.exr"), "whole");
}

TEST(StaleTemporaries, GoThoughNobodyHasWaitedForTheirProcess) {
    const TemporaryFolder folder;
    const pid_t child = fork();
    if (child == 0) _exit(0);
    siginfo_t info{};
    ASSERT_EQ(waitid(P_PID, id_t(child), &info, WEXITED | WNOWAIT), 0);
    write_text(temporary_of(folder / "out.exr", child), "half");
    EXPECT_EQ(remove_stale_temporaries(folder.path()).size(), 1u);
    waitpid(child, nullptr, 0);
}

TEST(StaleTemporaries, StayWhileTheirProcessRunsOrTheirLockIsHeld) {
    const TemporaryFolder folder;
    const AtomicFile own(folder / "own.exr");
    ASSERT_TRUE(fs::exists(own.temporary_path()));
    const fs::path of_init = temporary_of(folder / "a.exr", 1);
    write_text(of_init, "half");
    // The process of another PID namespace looks dead from here; its lock says otherwise.
    const fs::path locked = temporary_of(folder / "b.exr", dead_process());
    write_text(locked, "half");
    const int lock = open(locked.c_str(), O_RDONLY | O_CLOEXEC);
    ASSERT_EQ(flock(lock, LOCK_EX | LOCK_NB), 0);
    EXPECT_TRUE(remove_stale_temporaries(folder.path()).empty());
    close(lock);
    EXPECT_EQ(remove_stale_temporaries(folder.path()), std::vector<fs::path>{locked});
}

TEST(StaleTemporaries, AreNoFilesOfOthers) {
    const TemporaryFolder folder;
    const std::string dead = std::to_string(dead_process());
    const std::string own = temporary_of(folder / "out.exr", dead_process()).filename().string();
    const std::string host = own.substr(own.rfind(".aftershade-"));
    std::vector<std::string> names = {
        ".out.exr." + dead + "-0.tmp",                          // no mark
        ".out.exr.aftershade-another-host-" + dead + "-0.tmp",  // cannot be seen from here
        own.substr(1),                                          // not hidden
        own + "~",
        own.substr(0, own.size() - 6) + "-x.tmp",
        "out.exr.tmp",
        ".out.exr" + host.substr(0, host.find('-') + 1) + "-" + dead + ".tmp",
    };
    for (const std::string& name : names) write_text(folder / name, "theirs");
    fs::create_directory(folder / own);  // a folder of that name
    EXPECT_TRUE(remove_stale_temporaries(folder.path()).empty());
    for (const std::string& name : names) EXPECT_TRUE(fs::exists(folder / name)) << name;
}

TEST(AtomicFiles, HaveTemporaryNamesThatAFileSystemTakes) {
    const TemporaryFolder folder;
    AtomicFile file(folder / std::string(250, 'n'));
    EXPECT_LE(file.temporary_path().filename().string().size(), 255u);
    ASSERT_TRUE(fs::exists(file.temporary_path()));
    file.commit();
    EXPECT_TRUE(fs::exists(folder / std::string(250, 'n')));
    EXPECT_EQ(folder.file_count(), 1u);
}

TEST(AtomicFiles, TakeAnotherTemporaryNameWhereALinkIsPlanted) {
    const TemporaryFolder folder;
    write_text(folder / "secret", "secret");
    fs::path next;
    {
        const AtomicFile file(folder / "f");
        next = file.temporary_path();
    }
    // The counter goes on from here.
    const std::string text = next.string();
    const std::size_t dash = text.rfind('-');
    const unsigned number = unsigned(std::stoul(text.substr(dash + 1)));
    for (unsigned i = 1; i <= 3; ++i)
        fs::create_symlink("secret", text.substr(0, dash + 1) + std::to_string(number + i) + ".tmp");
    write_text_file(folder / "f", "text");
    EXPECT_EQ(read_text(folder / "f"), "text");
    EXPECT_EQ(read_text(folder / "secret"), "secret");
}

TEST(OutputFolder, IsMadeWithTheFoldersAboveIt) {
    const TemporaryFolder folder;
    prepare_output_folder(folder / "a/b/out.exr");
    EXPECT_TRUE(fs::is_directory(folder / "a/b"));
    EXPECT_NO_THROW(prepare_output_folder("")) << "no file";
    write_text(folder / "file", "");
    for (const char* path : {"file/out.exr", "file/below/out.exr"}) {
        try {
            prepare_output_folder(folder / path);
            FAIL() << path;
        } catch (const Error& error) {
            EXPECT_EQ(error.kind(), ErrorKind::output);
            EXPECT_TRUE(std::string(error.what()).starts_with((folder / path).string() + ": "))
                << error.what();
        }
    }
}

fs::perms mode_of(const fs::path& file) {
    return fs::status(file).permissions() & fs::perms::all;
}

constexpr fs::perms kOwnerOnly = fs::perms::owner_read | fs::perms::owner_write;

TEST(AtomicFiles, KeepThePermissionsOfWhatTheyReplaceAndElseTakeTheUmasks) {
    const TemporaryFolder folder;
    for (const fs::perms mode : {kOwnerOnly, fs::perms(0640), fs::perms(0777), fs::perms(0444)}) {
        fs::remove(folder / "f");
        write_text(folder / "f", "old");
        fs::permissions(folder / "f", mode);
        const AtomicFile open_one(folder / "f");
        EXPECT_EQ(mode_of(open_one.temporary_path()) & fs::perms(0077), mode & fs::perms(0055))
            << "nobody else may read it while it is written; umask 022";
        write_text_file(folder / "f", "new");
        EXPECT_EQ(mode_of(folder / "f"), mode);
        EXPECT_EQ(read_text(folder / "f"), "new");
    }
    const mode_t before = umask(0027);
    write_text_file(folder / "made", "");
    umask(before);
    EXPECT_EQ(mode_of(folder / "made"), fs::perms(0640));
}

TEST(AtomicFiles, ReplaceWhatALinkLeadsToAndKeepTheLink) {
    const TemporaryFolder folder;
    fs::create_directory(folder / "store");
    write_text(folder / "store/real", "old");
    fs::permissions(folder / "store/real", kOwnerOnly);
    fs::create_symlink("store/real", folder / "second");
    fs::create_symlink("second", folder / "first");
    fs::create_symlink("store/later", folder / "dangling");
    const AtomicFile open_one(folder / "first");
    EXPECT_EQ(open_one.temporary_path().parent_path().lexically_normal(), folder / "store");
    write_text_file(folder / "first", "new");
    EXPECT_TRUE(fs::is_symlink(folder / "first"));
    EXPECT_TRUE(fs::is_symlink(folder / "second"));
    EXPECT_EQ(read_text(folder / "store/real"), "new");
    EXPECT_EQ(mode_of(folder / "store/real"), kOwnerOnly);
    write_text_file(folder / "dangling", "made");
    EXPECT_EQ(read_text(folder / "store/later"), "made");
}

TEST(AtomicFiles, TakeTheBytesOfAnotherFileAndNameTheirOwnPathWhereThatFails) {
    const TemporaryFolder folder;
    write_text(folder / "from", std::string("a\0b\r\n", 5));
    write_text(folder / "to", "old and longer");
    AtomicFile copy(folder / "to");
    copy.copy_from(folder / "from");
    EXPECT_EQ(read_text(folder / "to"), "old and longer");
    copy.commit();
    EXPECT_EQ(read_text(folder / "to"), read_text(folder / "from"));
    try {
        AtomicFile(folder / "to").copy_from(folder / "absent");
        FAIL() << "the file is absent";
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::output);
        EXPECT_EQ(std::string(error.what()), (folder / "to").string() + ": '" + (folder / "absent").string() +
                                                 "' cannot be read: No such file or directory");
    }
    EXPECT_EQ(folder.file_count(), 2u) << "no temporary file stays";
    fs::permissions(folder / "to", kOwnerOnly);
    AtomicFile again(folder / "to");
    again.copy_from(folder / "from");
    EXPECT_EQ(mode_of(again.temporary_path()), kOwnerOnly);
}

/// What writing text there fails with; "" where it does not.
std::string write_fault(const fs::path& path) {
    try {
        write_text_file(path, "text");
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::output);
        return error.what();
    }
    return "";
}

TEST(AtomicFiles, FailWhereLinksGoRound) {
    const TemporaryFolder folder;
    fs::create_symlink("b", folder / "a");
    fs::create_symlink("a", folder / "b");
    EXPECT_NE(write_fault(folder / "a").find("Too many levels of symbolic links"), std::string::npos);
    EXPECT_EQ(folder.file_count(), 2u);
    EXPECT_TRUE(fs::is_symlink(folder / "a"));
}

TEST(AtomicFiles, LeaveTextToPipesAndDevicesAndRefuseToReplaceThem) {
    const TemporaryFolder folder;
    ASSERT_EQ(mkfifo((folder / "pipe").c_str(), 0600), 0);
    EXPECT_NE(write_fault(folder / "pipe").find("it is a pipe without a reader"), std::string::npos);
    const int reader = open((folder / "pipe").c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
    EXPECT_EQ(write_fault(folder / "pipe"), "");
    char bytes[8] = {};
    EXPECT_EQ(read(reader, bytes, sizeof bytes), 4);
    close(reader);
    EXPECT_EQ(std::string(bytes), "text");
    EXPECT_TRUE(fs::is_fifo(folder / "pipe"));
    EXPECT_EQ(write_fault("/dev/null"), "");
    EXPECT_NE(write_fault("/dev/full").find("/dev/full: cannot be written: No space left on device"),
              std::string::npos);
    for (const fs::path& path : {folder / "pipe", fs::path("/dev/null"), fs::path("/dev/stdout")})
        EXPECT_THROW(AtomicFile{path}, Error) << path;
}

TEST(AtomicFiles, ClearWhatKilledProcessesLeftBeforeTheFirstInAFolder) {
    const TemporaryFolder folder;
    fs::create_directory(folder / "sub");
    const fs::path stale =
        folder / "sub" / temporary_of(folder / "out.exr", dead_process()).filename().string();
    write_text(stale, "half");
    write_text_file(folder / "sub/f", "text");
    EXPECT_FALSE(fs::exists(stale));
}

TEST(AtomicFolders, AppearWholeOrNotAtAll) {
    const TemporaryFolder folder;
    {
        const AtomicFolder never(folder / "made");
        write_text(never.temporary_path() / "f", "text");
        EXPECT_FALSE(fs::exists(folder / "made"));
    }
    EXPECT_EQ(folder.file_count(), 0u);
    AtomicFolder made(folder / "made");
    write_text(made.temporary_path() / "f", "text");
    made.commit();
    EXPECT_EQ(read_text(folder / "made/f"), "text");
    AtomicFolder second(folder / "made");
    EXPECT_THROW(second.commit(), Error) << "something has the name by now";
    EXPECT_EQ(read_text(folder / "made/f"), "text");
}

TEST(AtomicFolders, ClearWhatKilledProcessesLeft) {
    const TemporaryFolder folder;
    const std::string own = AtomicFolder(folder / "made").temporary_path().filename().string();
    const std::string mark = "-" + std::to_string(getpid()) + "-";
    std::string stale = own;
    stale.replace(own.rfind(mark), mark.size(), "-" + std::to_string(dead_process()) + "-");
    fs::create_directory(folder / stale);
    write_text(folder / stale / "f", "half");
    const AtomicFolder next(folder / "other");
    EXPECT_FALSE(fs::exists(folder / stale));
}

/// A container's processes have the same numbers after each start.
TEST(AtomicFolders, PassByWhatAnEarlierProcessOfTheirNumberLeft) {
    const TemporaryFolder folder;
    const std::string own = AtomicFolder(folder / "made").temporary_path().filename().string();
    const std::size_t number = own.rfind('-') + 1, end = own.find_first_not_of("0123456789", number);
    const int last = std::stoi(own.substr(number, end - number));
    const fs::path left = folder / (own.substr(0, number) + std::to_string(last + 1) + own.substr(end));
    fs::create_directory(left);
    const AtomicFolder next(folder / "made");
    EXPECT_NE(next.temporary_path(), left);
    EXPECT_TRUE(fs::exists(left)) << "it may be of a process that runs";
}

}  // namespace
}  // namespace aftershade::test
