#include "framework/base/input_files.h"

#include <gtest/gtest.h>

#include <sstream>

#include "framework/document/document.h"
#include "tests/temporary_folder.h"

namespace aftershade::test {
namespace {

namespace fs = std::filesystem;

std::string fault_of(InputFiles& inputs, const fs::path& output) {
    Diagnostics diagnostics;
    inputs.check_output({"-o"}, output, diagnostics);
    std::ostringstream text;
    diagnostics.print(text);
    return text.str();
}

TEST(InputFiles, AreKnownByAnyPathAndAnyLink) {
    const TemporaryFolder folder;
    write_text(folder / "in", "");
    fs::create_directory(folder / "sub");
    fs::create_symlink("in", folder / "soft");
    fs::create_hard_link(folder / "in", folder / "hard");
    fs::create_directory_symlink(".", folder / "again");
    InputFiles inputs;
    inputs.add(folder / "in");
    for (const char* name : {"in", "sub/../in", "soft", "hard", "again/in"})
        EXPECT_EQ(fault_of(inputs, folder / name),
                  "-o: error: would replace the input " + (folder / "in").string() + "\n")
            << name;
    EXPECT_EQ(fault_of(inputs, folder / "sub/in"), "");
    EXPECT_EQ(fault_of(inputs, ""), "") << "no file";
}

TEST(InputFiles, AreKnownByTheirPathWhereTheyAreNotThereYet) {
    const TemporaryFolder folder;
    fs::create_directory_symlink(".", folder / "again");
    InputFiles inputs;
    inputs.add(folder / "frame_0003.exr");
    EXPECT_NE(fault_of(inputs, folder / "again/frame_0003.exr"), "");
    EXPECT_EQ(fault_of(inputs, folder / "frame_0004.exr"), "");
}

TEST(InputFiles, NoteOutputsSoThatTwoAreNotOneFile) {
    const TemporaryFolder folder;
    fs::create_directory(folder / "sub");
    InputFiles inputs;
    EXPECT_EQ(fault_of(inputs, folder / "out"), "");
    EXPECT_EQ(fault_of(inputs, folder / "sub/../out"), "-o: error: another output has this name\n");
    EXPECT_EQ(fault_of(inputs, "/dev/null"), "");
    EXPECT_EQ(fault_of(inputs, "/dev/null"), "") << "a device takes any number";
}

TEST(InputFiles, HaveEveryDocumentThatDiagnosticsNoted) {
    const TemporaryFolder folder;
    write_text(folder / "a.json", "{}");
    Diagnostics diagnostics;
    read_document(folder / "a.json", diagnostics);
    write_text(folder / "b.json", "{");
    read_document(folder / "b.json", diagnostics);
    InputFiles inputs;
    inputs.add(diagnostics.documents());
    EXPECT_NE(fault_of(inputs, folder / "a.json"), "");
    EXPECT_NE(fault_of(inputs, folder / "b.json"), "") << "with a fault";
    EXPECT_EQ(fault_of(inputs, folder / "c.json"), "");
}

}  // namespace
}  // namespace aftershade::test
