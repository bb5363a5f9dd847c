#include "framework/effect/program_store.h"

#include <chrono>
#include <cstdlib>
#include <string>
#include <thread>

#include "tests/documents.h"
#include "tests/temporary_folder.h"

namespace aftershade {
namespace {

namespace fs = std::filesystem;

gpu::ProgramBinary binary_of(const std::string& text, unsigned int format = 7) {
    gpu::ProgramBinary binary;
    binary.format = format;
    for (const char c : text) binary.bytes.push_back(std::byte(c));
    return binary;
}

std::string text_of(const std::optional<gpu::ProgramBinary>& binary) {
    if (!binary) return "nothing";
    std::string text;
    for (const std::byte b : binary->bytes) text += char(b);
    return text + "/" + std::to_string(binary->format);
}

TEST(ProgramStore, GivesBackWhatItKept) {
    const test::TemporaryFolder folder;
    const ProgramStore store(folder / "a/b");
    EXPECT_EQ(text_of(store.load("llvmpipe one")), "nothing");
    store.save("llvmpipe one", binary_of("first"));
    store.save("llvmpipe two", binary_of("second", 8));
    EXPECT_EQ(text_of(store.load("llvmpipe one")), "first/7");
    EXPECT_EQ(text_of(store.load("llvmpipe two")), "second/8");
    EXPECT_EQ(text_of(store.load("radeonsi one")), "nothing") << "another renderer is another key";
    store.save("llvmpipe one", binary_of("changed"));
    EXPECT_EQ(text_of(store.load("llvmpipe one")), "changed/7");
}

TEST(ProgramStore, TakesAKeyOfTheSameHashForAMiss) {
    const test::TemporaryFolder folder;
    const ProgramStore store(folder.path());
    store.save("one", binary_of("first"));
    fs::rename(store.file_of("one"), store.file_of("two"));  // as if both had one hash
    EXPECT_EQ(text_of(store.load("two")), "nothing");
    store.save("two", binary_of("second"));
    EXPECT_EQ(text_of(store.load("two")), "second/7");
}

TEST(ProgramStore, DropsTheOldestProgramsBeyondItsLimit) {
    const test::TemporaryFolder folder;
    const ProgramStore store(folder.path(), 3000);
    const auto now = fs::file_time_type::clock::now();
    for (int i = 0; i < 5; ++i) {
        const std::string key = "key " + std::to_string(i);
        store.save(key, binary_of(std::string(900, 'x')));
        fs::last_write_time(store.file_of(key), now - std::chrono::seconds(100 - i));
    }
    test::write_text(folder / "notes.txt", std::string(5000, 'n'));
    store.save("last", binary_of("small"));
    for (const char* gone : {"key 0", "key 1"}) EXPECT_EQ(text_of(store.load(gone)), "nothing") << gone;
    for (const char* kept : {"key 3", "key 4", "last"})
        EXPECT_NE(text_of(store.load(kept)), "nothing") << kept;
    EXPECT_TRUE(fs::exists(folder / "notes.txt")) << "not a program";
}

TEST(ProgramStore, TrustsNoFileThatIsShortOrChanged) {
    const test::TemporaryFolder folder;
    const ProgramStore store(folder.path());
    store.save("key", binary_of("a program"));
    const std::string whole = test::read_text(store.file_of("key"));
    for (std::size_t size = 0; size < whole.size(); ++size) {
        test::write_text(store.file_of("key"), whole.substr(0, size));
        EXPECT_EQ(text_of(store.load("key")), "nothing") << "cut to " << size;
    }
    for (std::size_t at = 0; at < whole.size(); ++at) {
        std::string changed = whole;
        changed[at] = char(changed[at] ^ 0x40);
        test::write_text(store.file_of("key"), changed);
        EXPECT_EQ(text_of(store.load("key")), "nothing") << "byte " << at << " changed";
    }
    test::write_text(store.file_of("key"), whole + "x");
    EXPECT_EQ(text_of(store.load("key")), "nothing");
    store.save("key", binary_of("a program"));
    EXPECT_EQ(test::read_text(store.file_of("key")), whole);
}

TEST(ProgramStore, KeepsNothingWhereItCannotWrite) {
    const test::TemporaryFolder folder;
    test::write_text(folder / "file", "");
    const ProgramStore under_a_file(folder / "file/cache");
    EXPECT_NO_THROW(under_a_file.save("key", binary_of("x")));
    EXPECT_EQ(text_of(under_a_file.load("key")), "nothing");
    const ProgramStore in_proc("/proc/aftershade-cache");
    EXPECT_NO_THROW(in_proc.save("key", binary_of("x")));
    const ProgramStore store(folder / "cache");
    fs::create_directories(store.file_of("key"));  // a folder where the file would be
    EXPECT_NO_THROW(store.save("key", binary_of("x")));
    EXPECT_EQ(text_of(store.load("key")), "nothing");
}

TEST(ProgramStore, IsSharedByThreads) {
    const test::TemporaryFolder folder;
    const std::string one(200000, 'a'), two(100000, 'b');
    const auto work = [&](const std::string& text) {
        const ProgramStore store(folder.path());
        for (int i = 0; i < 20; ++i) {
            store.save("key", binary_of(text));
            const std::string read = text_of(store.load("key"));
            EXPECT_TRUE(read == one + "/7" || read == two + "/7") << read.size();
        }
    };
    std::thread first(work, one), second(work, two);
    first.join();
    second.join();
    EXPECT_EQ(folder.file_count(), 1U);
}

/// Sets variables of the environment until the end of the test; nullptr unsets.
class Environment {
public:
    Environment(std::initializer_list<std::pair<const char*, const char*>> values) {
        for (const auto& [name, value] : values) {
            const char* old = std::getenv(name);
            before_.emplace_back(name, old ? std::optional<std::string>(old) : std::nullopt);
            set(name, value);
        }
    }
    ~Environment() {
        for (const auto& [name, value] : before_) set(name.c_str(), value ? value->c_str() : nullptr);
    }
    Environment(const Environment&) = delete;
    Environment& operator=(const Environment&) = delete;

private:
    static void set(const char* name, const char* value) {
        if (value) setenv(name, value, 1);
        else unsetenv(name);
    }
    std::vector<std::pair<std::string, std::optional<std::string>>> before_;
};

fs::path folder_of(const char* cache, const char* xdg, const char* home) {
    const Environment environment{{"AFTERSHADE_CACHE", cache}, {"XDG_CACHE_HOME", xdg}, {"HOME", home}};
    return ProgramStore::from_environment().folder();
}

TEST(ProgramStore, LiesWhereTheEnvironmentSays) {
    EXPECT_EQ(folder_of("/c", "/x", "/h"), "/c");
    EXPECT_EQ(folder_of(nullptr, "/x", "/h"), "/x/aftershade");
    EXPECT_EQ(folder_of(nullptr, "relative", "/h"), "/h/.cache/aftershade");
    EXPECT_EQ(folder_of("", nullptr, "/h"), "/h/.cache/aftershade");
    EXPECT_EQ(folder_of("off", "/x", "/h"), "");
    EXPECT_EQ(folder_of(nullptr, nullptr, nullptr), "");
    EXPECT_FALSE(ProgramStore().is_on());
    EXPECT_NO_THROW(ProgramStore().save("key", binary_of("x")));
}

}  // namespace
}  // namespace aftershade
