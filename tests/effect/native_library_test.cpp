#include "framework/effect/native/native_library.h"

#include <gtest/gtest.h>

#include <cstdlib>

#include "framework/base/error.h"
#include "tests/temporary_folder.h"

namespace aftershade {

std::span<const StaticNativeLibrary> test_native_libraries();

namespace {

namespace fs = std::filesystem;
const fs::path kCases = AFTERSHADE_CASES;

/// What open() says of a file, which it must refuse.
std::string refusal(const fs::path& file) {
    try {
        NativeLibrary::open(file);
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::effect);
        return error.what();
    }
    ADD_FAILURE() << file << " was taken";
    return "";
}

void expect_all_in(const std::string& text, const std::vector<std::string>& parts) {
    for (const std::string& part : parts)
        EXPECT_NE(text.find(part), std::string::npos) << part << "\n" << text;
}

TEST(NativeLibrary, TakesThisMinorAnOlderAndANewerOne) {
    EXPECT_EQ(NativeLibrary::open(kCases / "current.so")->effects().at(0).id, "case");
    EXPECT_EQ(NativeLibrary::open(kCases / "older.so")->effects().at(0).id, "older");
    const auto newer = NativeLibrary::open(kCases / "newer.so");
    EXPECT_EQ(newer->effects().at(0).id, "newer");
    EXPECT_EQ(newer->contact(), "");
}

TEST(NativeLibrary, RefusesAnotherMajorWithBothVersionsAndARemedy) {
    expect_all_in(refusal(kCases / "wrong_major.so"),
                  {(kCases / "wrong_major.so").string(), "ABI 2.1", "takes 1.x", "1.1", "rebuild"});
}

TEST(NativeLibrary, RefusesAStructSmallerThanThatOfOneZero) {
    expect_all_in(refusal(kCases / "small_struct.so"),
                  {"small_struct.so", "struct_size is 24", "ABI 1.0", "host 1.1"});
}

TEST(NativeLibrary, RefusesWhatIsNoPlugin) {
    const test::TemporaryFolder folder;
    test::write_text(folder / "text.so", "not a library");
    expect_all_in(refusal(folder / "text.so"), {"text.so", "cannot be loaded"});
    expect_all_in(refusal(folder / "absent.so"), {"absent.so", "no such file"});
    expect_all_in(refusal(kCases / "no_symbol.so"), {"no_symbol.so", "'aftershade_library_entry'"});
    expect_all_in(refusal(kCases / "null_factory.so"), {"null_factory.so", "get_factory returned NULL"});
}

TEST(NativeLibrary, ReadsNoFieldOfAnOlderLibraryThatItDoesNotHave) {
    struct {
        aftershade_library library;
    } memory{};
    memory.library.struct_size = offsetof(aftershade_library, contact);
    memory.library.abi_major = 1;
    memory.library.name = memory.library.version = "x";
    memory.library.factory_count = 1;
    memory.library.get_factory = [](uint32_t) -> const aftershade_factory* { return nullptr; };
    memory.library.contact = "beyond its size";
    EXPECT_EQ(checked_library(memory.library, "x").contact, nullptr);
}

TEST(NativeRegistry, NamesBothLibrariesOfOneEffectAndStillOffersTheOthers) {
    const test::TemporaryFolder folder;
    for (const char* name : {"current.so", "duplicate.so", "older.so", "wrong_major.so"})
        fs::copy_file(kCases / name, folder / name);
    NativeRegistry registry({folder.path(), folder.path()}, test_native_libraries());
    EXPECT_EQ(registry.ids(), (std::vector<std::string>{"case", "linked_demo", "older"}));
    EXPECT_EQ(registry.find("older", "1.0.0").library->place(), (folder / "older.so").string());
    try {
        registry.find("case", "1.0.0");
        ADD_FAILURE();
    } catch (const Error& error) {
        expect_all_in(error.what(), {(folder / "current.so").string(), (folder / "duplicate.so").string()});
    }
}

TEST(NativeRegistry, SaysWhereItLookedAndWhatItRefused) {
    const test::TemporaryFolder folder;
    fs::copy_file(kCases / "wrong_major.so", folder / "wrong_major.so");
    fs::copy_file(kCases / "older.so", folder / "older.so");
    NativeRegistry registry({folder.path()}, {});
    for (const auto& [id, version, parts] :
         std::vector<std::tuple<std::string, std::string, std::vector<std::string>>>{
             {"oldr", "1.0.0", {folder.path().string(), "did you mean 'older'?", "refused", "ABI 2.1"}},
             {"older", "1.2.0", {"older.so", "version 1.0.0", "version 1.2.0"}}})
        try {
            registry.find(id, version);
            ADD_FAILURE() << id;
        } catch (const Error& error) {
            expect_all_in(error.what(), parts);
        }
    NativeRegistry nowhere({folder / "absent"}, {});
    EXPECT_THROW(nowhere.ids(), Error);
}

TEST(NativeRegistry, SearchesTheFoldersGivenThenThoseOfTheEnvironment) {
    setenv("AFTERSHADE_PLUGIN_PATH", "/b::/c:", 1);
    EXPECT_EQ(native_search_path({"/a"}), (std::vector<fs::path>{"/a", "/b", "/c"}));
    unsetenv("AFTERSHADE_PLUGIN_PATH");
    EXPECT_EQ(native_search_path({}), std::vector<fs::path>{});
}

}  // namespace
}  // namespace aftershade
