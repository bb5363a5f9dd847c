// Golden and compare do not pass by accident: each input is spoiled in turn, and each time there is a reason.
#include <unistd.h>

#include <cmath>
#include <functional>
#include <limits>

#include "tests/cli/golden_suite.h"
#include "tests/not_finite.h"

namespace aftershade::test {
namespace {

namespace fs = std::filesystem;

class VerdictAudit : public GoldenCommand {
protected:
    /// The image again, after `change`.
    static void change_pixels(const fs::path& path, const std::function<void(Image&)>& change,
                              int width = 0) {
        const std::vector<std::string> names{"R", "G", "B", "A"};
        Image image = ExrFile(path).read_floats(0, names);
        if (width > 0) image = Image(width, image.height(), 4);
        change(image);
        std::vector<ExrOutputChannel> channels;
        for (int c = 0; c < 4; ++c)
            channels.push_back({names[std::size_t(c)], PixelType::float32, &image, c});
        ExrWriteOptions options;
        options.data_window = options.display_window = {0, 0, image.width() - 1, image.height() - 1};
        write_exr(path, channels, options);
    }
    fs::path corner() const { return image("corner.color.0001"); }
    static fs::path sidecar(const fs::path& image) { return fs::path(image).replace_extension(".json"); }
};

/// How one input is spoiled, and what follows.
struct Spoiled {
    const char* what;
    std::function<void()> spoil;
    std::vector<std::string> words;
    int exit_code;
    const char* reason;
};

TEST_F(VerdictAudit, OfASuiteWithEachOfItsInputsSpoiled) {
    approve();
    EXPECT_EQ(run().exit_code, 0) << "as it is";
    const auto whole = contents(folder_.path());
    const auto restore = [&] {
        for (const auto& entry : fs::directory_iterator(folder_.path())) fs::remove_all(entry.path());
        for (const auto& [name, bytes] : whole) {
            fs::create_directories((folder_ / name).parent_path());
            if (name == "goldens") fs::create_directory(folder_ / name);
            else write_text(folder_ / name, bytes);
        }
    };
    const std::vector<std::string> one = {"--filter", "corner"};
    const std::vector<Spoiled> cases = {
        {"a missing capture", [&] { fs::remove(folder_ / "in_0001.exr"); }, one, 4, "no capture in_0001.exr"},
        {"a truncated capture", [&] { fs::resize_file(folder_ / "in_0001.exr", 2000); }, one, 4,
         "in_0001.exr"},
        {"an empty suite",
         [&] { write_text(folder_ / "golden.json", R"({ "aftershade": 1, "cases": [] })"); },
         {},
         64,
         "a suite needs 'cases' or 'cases_of_effects'"},
        {"a missing golden", [&] { fs::remove(corner()), fs::remove(sidecar(corner())); }, one, 2,
         "no golden goldens/corner.color.0001.exr"},
        {"a truncated golden", [&] { fs::resize_file(corner(), fs::file_size(corner()) / 2); }, one, 4,
         "corner.color.0001.exr"},
        {"an empty golden", [&] { write_text(corner(), ""); }, one, 4, "the file is empty"},
        {"a sidecar of another image",
         [&] { write_text(sidecar(corner()), read_text(sidecar(image("lens.color.0001")))); }, one, 1,
         "corner.color.0001.json: is of another image than corner.color.0001.exr"},
        {"a sidecar that is not JSON", [&] { write_text(sidecar(corner()), "approved by me"); }, one, 4,
         "corner.color.0001.json: is not a sidecar, not even a JSON object"},
        {"a sidecar alone", [&] { fs::remove(corner()); }, {}, 2, "no case gives this golden"},
        {"an empty look",
         [&] { write_text(folder_ / "lens.json", ""); },
         {"--filter", "lens"},
         2,
         "lens.json"},
        {"a missing look", [&] { fs::remove(folder_ / "lens.json"); }, {}, 64, "no file 'lens.json'"},
        {"a golden of another size",
         [&] {
             change_pixels(
                 corner(), [](Image&) {}, 10);
         },
         one, 3, "10"},
        {"NaN in the golden",
         [&] { change_pixels(corner(), [](Image& pixels) { pixels.at(3, 4, 1) = kNan; }); }, one, 2,
         "corner.color.0001: RGB: 1 pixels differ"},
        {"a filter that fits nothing", [] {}, {"--filter", "corners"}, 64, "did you mean 'corner'?"},
        {"an output that no golden has",
         [&] {
             write_suite(R"("fail": 0.004)", R"(, { "name": "more",
            "steps": [], "capture": "in_0001.exr" })");
         },
         {"--filter", "more"},
         2,
         "no golden goldens/more"},
        {"nothing but skipped cases",
         [&] {
             write_text(
                 folder_ / "golden.json",
                 R"({ "aftershade": 1, "cases": [ { "name": "corner", "steps": [], "capture": "in_0001.exr",
            "skip": "later" }, { "name": "lens", "steps": [], "capture": "in_0001.exr", "skip": "later" } ] })");
         },
         one, 1, "every case was skipped; nothing was compared"},
    };
    for (const Spoiled& test : cases) {
        test.spoil();
        const CommandResult result = run(test.words);
        EXPECT_EQ(result.exit_code, test.exit_code) << test.what << "\n" << result.err;
        EXPECT_NE(result.err.find(test.reason), std::string::npos) << test.what << "\n" << result.err;
        restore();
    }
    const CommandResult elsewhere = golden({"run", "no/suite"});
    EXPECT_EQ(elsewhere.exit_code, 64) << elsewhere.err;
    EXPECT_NE(elsewhere.err.find("no/suite: error: no such file"), std::string::npos) << elsewhere.err;
    EXPECT_EQ(run().exit_code, 0) << "whole again";
}

TEST_F(VerdictAudit, OfAnApprovalThatCannotWrite) {
    approve();
    write_frame(1, 40);
    fs::permissions(folder_ / "goldens", fs::perms::owner_read | fs::perms::owner_exec |
                                             fs::perms::others_read | fs::perms::others_exec);
    std::vector<std::string> words = aftershade_words({"golden", "approve", "golden.json"});
    if (geteuid() == 0) {  // whom permissions do not stop
        if (!fs::exists("/usr/bin/setpriv")) GTEST_SKIP() << "root needs setpriv to be somebody else";
        words.insert(words.begin(), {"/usr/bin/setpriv", "--reuid", "65534", "--clear-groups"});
    }
    const auto before = contents(folder_ / "goldens");
    const CommandResult result = Command(words, folder_.path()).wait();
    EXPECT_EQ(result.exit_code, 4) << result.err;
    EXPECT_NE(result.err.find("nothing can be written into the folder 'goldens': Permission denied"),
              std::string::npos)
        << result.err;
    EXPECT_EQ(contents(folder_ / "goldens"), before);
}

TEST_F(VerdictAudit, OfAnApprovalWhoseCaptureIsAbsent) {
    approve();
    fs::remove(folder_ / "in_0001.exr");
    const CommandResult result = golden({"approve", "golden.json", "--filter", "corner"});
    EXPECT_EQ(result.exit_code, 4) << result.err;
    EXPECT_NE(result.err.find("FAILED corner: not approved, its goldens are as they were"), std::string::npos)
        << result.err;
    EXPECT_NE(result.err.find("(set \"optional\": true in the case if its capture may be missing)"),
              std::string::npos)
        << result.err;
}

TEST_F(VerdictAudit, OfTwoPicturesOfWhichOneIsSpoiled) {
    const fs::path a = folder_ / "in_0001.exr", b = folder_ / "in_0002.exr";
    const auto compare = [&](int exit_code, const std::string& reason) {
        const CommandResult result =
            run_aftershade({"compare", "in_0001.exr", "in_0002.exr"}, folder_.path());
        EXPECT_EQ(result.exit_code, exit_code) << reason << "\n" << result.err << result.out;
        EXPECT_NE((result.err + result.out).find(reason), std::string::npos) << result.err << result.out;
    };
    fs::remove(b);
    compare(4, "in_0002.exr");
    write_text(b, "");
    compare(4, "the file is empty");
    fs::copy_file(a, b, fs::copy_options::overwrite_existing);
    fs::resize_file(b, fs::file_size(b) - 1);
    compare(4, "cut off");
    fs::remove(b);
    fs::create_directory(b);
    compare(4, "is not a regular file");
    fs::remove(b);
    fs::copy_file(a, b);
    change_pixels(a, [](Image&) {});
    change_pixels(b, [](Image& pixels) { pixels.at(3, 4, 1) = kNan; });
    compare(2, "NaN");
    change_pixels(
        b, [](Image&) {}, 10);
    compare(3, "10");
}

}  // namespace
}  // namespace aftershade::test
