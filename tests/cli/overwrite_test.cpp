// No verb writes over what it reads, by whatever path, and none has begun by then.
#include <filesystem>

#include "framework/batch/process_codes.h"
#include "tests/cli/batch_work.h"

namespace aftershade::test {
namespace {

namespace fs = std::filesystem;

class Overwriting : public BatchWork {
protected:
    Overwriting() {
        write_frames(1, 3);
        write_text(folder_ / "used.json", R"({ "aftershade": 1, "steps": [ { "effect": "spread" } ] })");
        write_text(folder_ / "look.json", R"({ "aftershade": 1, "steps": [ { "use": "used.json" },
            { "effect": "trail", "mask": { "file": "mask.png" } } ] })");
        write_text(folder_ / "mask.png", black_png());
        write_text(folder_ / "capture.json",
                   R"({ "aftershade": 1, "frames": "in_####.exr", "range": "1-2", "profile": "native" })");
        fs::create_symlink("in_0001.exr", folder_ / "link.exr");
        fs::create_hard_link(folder_ / "mask.png", folder_ / "same.png");
    }
    /// A PNG of one black pixel, made by Python's zlib and struct.
    static std::string black_png() {
        constexpr unsigned char bytes[] = {
            0x89, 0x50, 0x4e, 0x47, 0x0d, 0x0a, 0x1a, 0x0a, 0x00, 0x00, 0x00, 0x0d, 0x49, 0x48,
            0x44, 0x52, 0x00, 0x00, 0x00, 0x01, 0x00, 0x00, 0x00, 0x01, 0x08, 0x00, 0x00, 0x00,
            0x00, 0x3a, 0x7e, 0x9b, 0x55, 0x00, 0x00, 0x00, 0x0a, 0x49, 0x44, 0x41, 0x54, 0x78,
            0x9c, 0x63, 0x60, 0x00, 0x00, 0x00, 0x02, 0x00, 0x01, 0x48, 0xaf, 0xa4, 0x71, 0x00,
            0x00, 0x00, 0x00, 0x49, 0x45, 0x4e, 0x44, 0xae, 0x42, 0x60, 0x82};
        return {std::begin(bytes), std::end(bytes)};
    }
    /// The command ends at once with `code`, says what it would have replaced, and changes nothing.
    void expect_refused(const std::vector<std::string>& arguments, int code, const std::string& message) {
        const auto before = contents(folder_.path());
        const CommandResult result = run_aftershade(arguments, folder_.path());
        EXPECT_EQ(result.exit_code, code) << message << "\n" << result.err;
        EXPECT_NE(result.err.find(message), std::string::npos) << message << "\n" << result.err;
        EXPECT_EQ(contents(folder_.path()), before) << message;
    }
    void expect_run_refused(std::vector<std::string> more, const std::string& message) {
        if (more.front() != "-o") more.insert(more.end(), {"-o", "out_####.exr"});
        more.insert(more.begin(), {"look.json", "capture.json"});
        expect_refused(words(more), int(ExitCode::usage), message);
    }
};

TEST_F(Overwriting, OfWhatRunReadsIsRefusedForEveryOutput) {
    const std::vector<std::pair<std::string, std::string>> cases = {
        {"--history-out", "in_0002.exr"},
        {"--history-out", "./look.json"},
        {"--history-out", "effects/trail/show.frag"},
        {"--telemetry", "look.json"},
        {"--telemetry", "capture.json"},
        {"--telemetry", "effects/trail/effect.json"},
        {"--trace", "used.json"},
        {"--report", "link.exr"},
        {"--report", "in_0003.exr"},  // of the capture's pattern, though not of its range
        {"-o", "same.png"},
        {"-o", "in_####.exr"},
    };
    for (const auto& [word, file] : cases)
        expect_run_refused({word, file}, word + " " + file + ": error: would replace the input ");
    expect_run_refused({"--history-out", "in_0002.exr"}, "would replace the input in_0002.exr\n");
    expect_run_refused({"-o", "same.png"}, "would replace the input mask.png\n");
    expect_run_refused({"--tap", "trail.kept=in_####.exr"},
                       "--tap trail.kept=in_####.exr: error: would replace");
}

TEST_F(Overwriting, OfALookOfAnyNameByItsGraphOrPlotIsRefused) {
    for (const auto& [word, name] :
         {std::pair("--graph", "look.dot"), std::pair("--telemetry-plot", "look.svg")}) {
        fs::copy_file(folder_ / "nothing.json", folder_ / name);
        expect_refused(words({name, "capture.json", "-o", "out_####.exr", word, name}), int(ExitCode::usage),
                       std::string("would replace the input ") + name);
    }
}

TEST_F(Overwriting, OfOneOutputByAnotherIsRefused) {
    expect_run_refused({"--trace", "t.json", "--report", "./t.json"},
                       "--report ./t.json: error: another output has this name");
    expect_run_refused({"--trace", "t\x01.json", "--report", "./t\x01.json"},
                       "--report ./t?.json: error: another output has this name");
    expect_run_refused({"--history-out", "out_0002.exr"},
                       "-o out_####.exr: error: another output has this name");
}

TEST_F(Overwriting, OfAHistoryByTheNextIsMeant) {
    run({"trail.json", "in_0001.exr", "-o", "a.exr", "--history-out", "h"}, 0);
    run({"trail.json", "in_0002.exr", "-o", "b.exr", "--history-in", "h", "--history-out", "h"}, 0);
    const CommandResult result =
        run({"trail.json", "in_0002.exr", "-o", "c.exr", "--history-in", "h", "--report", "h"}, 2);
    EXPECT_NE(result.err.find("--report h: error: would replace the input h"), std::string::npos)
        << result.err;
}

TEST_F(Overwriting, OfWhatOtherVerbsReadIsRefused) {
    fs::copy_file(folder_ / "in_0001.exr", folder_ / "frame.png");
    expect_refused({"inspect", "frame.png", "--contact-sheet", "frame.png"}, 2,
                   "--contact-sheet frame.png: error: would replace the input frame.png");
    for (const char* word : {"-o", "--csv", "--heat-map"})
        expect_refused({"compare", "in_0001.exr", "in_0002.exr", word, "link.exr"}, 64,
                       std::string(word) + " link.exr: error: would replace the input in_0001.exr");
    expect_refused(
        {"compare", "in_0001.exr", "in_0002.exr", "--ignore", "mask:mask.png", "--csv", "same.png"}, 64,
        "--csv same.png: error: would replace the input mask.png");
    fs::copy_file(AFTERSHADE_SOURCE_DIR "/scenes/plane_edge/scene.json", folder_ / "set.json");
    fs::create_directory(folder_ / "set");
    fs::rename(folder_ / "set.json", folder_ / "set/capture.json");
    expect_refused({"render", "set/capture.json", "-o", "set"}, 2,
                   "would replace the input set/capture.json");
}

TEST_F(Overwriting, OfASuiteOrItsGoldensIsRefused) {
    write_text(folder_ / "golden.json", R"({ "aftershade": 1, "cases": [
        { "name": "in_0001", "steps": [], "capture": "goldens/in_0001.color.0001.exr", "frames": "1" } ] })");
    fs::create_directory(folder_ / "goldens");
    fs::copy_file(folder_ / "in_0001.exr", folder_ / "goldens/in_0001.color.0001.exr");
    expect_refused({"golden", "run", "golden.json", "--junit", "golden.json"}, 64,
                   "--junit golden.json: error: would replace the input golden.json");
    expect_refused({"golden", "run", "golden.json", "--junit", "goldens/in_0001.color.0001.exr"}, 64,
                   "would replace the input goldens/in_0001.color.0001.exr");
    expect_refused({"golden", "approve", "golden.json"}, 64,
                   "goldens/in_0001.color.0001.exr: would replace the input goldens/in_0001.color.0001.exr");
    fs::create_directory(folder_ / "report");
    write_text(folder_ / "report/report.json", "{}");
    expect_refused({"golden", "report", "report", "-o", "report/report.json"}, 64,
                   "would replace the input report/report.json");
}

}  // namespace
}  // namespace aftershade::test
