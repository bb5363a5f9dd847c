// What may go wrong in a batch, one row each: the exit code, what the user reads, and whole files only.
#include <functional>
#include <optional>
#include <regex>
#include <set>

#include "framework/batch/process_codes.h"
#include "tests/cli/batch_work.h"
#include "tests/cli/native_effect.h"
#include "tests/cli/small_disk.h"

namespace aftershade::test {
namespace {

namespace fs = std::filesystem;

constexpr int kFaultFrames = 4;

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool kCanLimitMemory = false;  // the sanitizer reserves terabytes of address space
#else
constexpr bool kCanLimitMemory = true;
#endif

struct BatchFault {
    std::string what;                    ///< a sentence, as the test's name
    std::vector<std::string> options{};  ///< beside the look, the capture and the output
    std::set<ExitCode> exit_codes;       ///< more than one where the machine decides
    std::string message;                 ///< regular expression, somewhere on stderr unless the exit is 0
    std::set<int> frames{};              ///< that are written, exactly
    std::string look = "nothing.json";
    std::function<void(const fs::path& folder)> prepare{};
    bool broken_gl = false;
    int limit_kB = 0;      ///< of the address space
    bool is_full = false;  ///< the outputs' disk
    bool is_read_only = false;
};
void PrintTo(const BatchFault& fault, std::ostream* out) {
    *out << fault.what;
}

fs::path second(const fs::path& folder) {
    return folder / "in_0002.exr";
}

void put_nan(const fs::path& folder) {
    Capture capture = make_capture({.width = 64, .height = 36, .background = {0.5f, 0.25f, 1}}, 2);
    capture.images.at("color").at(30, 17, 1) = kNan;
    write_capture(capture, second(folder));
}

std::function<void(const fs::path&)> plugin(const std::string& id) {
    return [id](const fs::path& folder) {
        write_native_effect(folder, id);
        write_text(folder / "look.json", R"({ "aftershade": 1, "steps": [ { "effect": ")" + id + "\" } ] }");
    };
}

std::vector<BatchFault> frame_faults() {
    const auto cut = [](const fs::path& folder) {
        fs::resize_file(second(folder), fs::file_size(second(folder)) / 2);
    };
    const auto remove = [](const fs::path& folder) { fs::remove(second(folder)); };
    const std::string is_cut = "in_0002\\.exr: cut off";
    const std::string is_nan = "frame 2: the role 'color' of in_0002\\.exr has 1 NaN pixel, at \\(30, 17\\)";
    return {
        {.what = "ATruncatedInputInTheMiddle",
         .exit_codes = {ExitCode::partial},
         .message = is_cut,
         .frames = {1, 3, 4},
         .prepare = cut},
        {.what = "ATruncatedInputForWorkers",
         .options = {"--jobs", "2"},
         .exit_codes = {ExitCode::partial},
         .message = "1 of 4 frames failed:\n  frame 2: " + is_cut,
         .frames = {1, 3, 4},
         .prepare = cut},
        {.what = "ANanFrameThatMayNotPass",
         .options = {"--on-nan", "fail"},
         .exit_codes = {ExitCode::partial},
         .message = is_nan,
         .frames = {1, 3, 4},
         .prepare = put_nan},
        {.what = "ANanFrameThatIsWarnedOf",
         .exit_codes = {ExitCode::done},
         .message = is_nan,
         .frames = {1, 2, 3, 4},
         .prepare = put_nan},
        {.what = "AMissingFrame",
         .exit_codes = {ExitCode::partial},
         .message = "frame 2 of 1-4 is missing",
         .frames = {1, 3, 4},
         .prepare = remove},
        {.what = "AMissingFrameForWorkers",
         .options = {"--jobs", "2"},
         .exit_codes = {ExitCode::partial},
         .message = "1 of 4 frames failed:\n  frame 2: in_0002\\.exr: ",
         .frames = {1, 3, 4},
         .prepare = remove},
    };
}

std::vector<BatchFault> machine_faults() {
    std::vector<BatchFault> faults = {
        {.what = "AFullDisk", .exit_codes = {ExitCode::output}, .message = "No space left", .is_full = true},
        {.what = "AFullDiskForWorkers",
         .options = {"--jobs", "2"},
         .exit_codes = {ExitCode::output},
         .message = "No space left",
         .is_full = true},
        {.what = "AReadOnlyFolder",
         .exit_codes = {ExitCode::output},
         .message = "Read-only file system",
         .is_read_only = true},
        {.what = "NoGl", .exit_codes = {ExitCode::gl}, .message = "no usable GL", .broken_gl = true},
        {.what = "NoGlForWorkers",
         .options = {"--jobs", "2"},
         .exit_codes = {ExitCode::gl},
         .message = "no usable GL",
         .broken_gl = true},
        {.what = "AnEmptyVariableOfFrames",
         .options = {"--frames", ""},
         .exit_codes = {ExitCode::usage},
         .message = "--frames: the value is empty; leave the option out, or set the variable"},
        {.what = "AnEmptyVariableOfAFarm",
         .options = {"--chunk", "auto"},
         .exit_codes = {ExitCode::usage},
         .message = "--chunk auto: error: no variable of Slurm"},
    };
    for (const int limit_kB : {300'000, 500'000, 700'000, 1'000'000})
        faults.push_back({.what = "AMemoryLimitOf" + std::to_string(limit_kB / 1000) + "MB",
                          .exit_codes = {ExitCode::done, ExitCode::memory},
                          .message = "out of memory",
                          .frames = {1, 2, 3, 4},
                          .limit_kB = limit_kB});
    return faults;
}

std::vector<BatchFault> plugin_faults() {
    return {
        {.what = "ANativeLibraryThatSleeps",
         .options = {"--plugin-path", kCases, "--plugin-timeout", "1"},
         .exit_codes = {ExitCode::effect},
         .message = "hangs\\.so .*frame 1.*--plugin-timeout",
         .look = "look.json",
         .prepare = plugin("hangs")},
        {.what = "APlugInThatCrashes",
         .options = {"--plugin-path", kCases},
         .exit_codes = {ExitCode::effect},
         .message = "crashes_late\\.so crashed \\(signal 11, SIGSEGV\\) in prepare of step 'crashes_late', "
                    "frame 3",
         .frames = {1, 2},
         .look = "look.json",
         .prepare = plugin("crashes_late")},
        {.what = "APlugInThatCrashesAWorker",
         .options = {"--plugin-path", kCases, "--jobs", "1"},
         .exit_codes = {ExitCode::partial},
         .message = "1 of 4 frames failed:\n  frame 3: plug-in .*crashes_late\\.so crashed",
         .frames = {1, 2, 4},
         .look = "look.json",
         .prepare = plugin("crashes_late")},
    };
}

class BatchFaultTest : public BatchWork, public testing::WithParamInterface<BatchFault> {
protected:
    BatchFaultTest() { write_frames(1, kFaultFrames); }

    CommandResult run_with_fault() {
        const BatchFault& fault = GetParam();
        std::vector<std::string> arguments{fault.look, "in_####.exr", "-o", "out/f_####.exr"};
        arguments.insert(arguments.end(), fault.options.begin(), fault.options.end());
        std::vector<std::string> all{"/bin/sh", "-c", "ulimit -c 0; exec \"$0\" \"$@\""};
        if (fault.limit_kB > 0) all[2] = "ulimit -v " + std::to_string(fault.limit_kB) + "; " + all[2];
        for (const std::string& word : aftershade_words(words(arguments))) all.push_back(word);
        return Command(all, folder_.path(), fault.broken_gl ? without_gl(folder_ / "no_gl") : Environment{})
            .wait();
    }
    void expect_whole_files_only(const CommandResult& result) const {
        EXPECT_TRUE(temporaries().empty());
        const bool has_all = !GetParam().limit_kB || result.exit_code == 0;
        for (int frame = 1; frame <= kFaultFrames; ++frame) {
            const std::string name = FramePattern("out/f_####.exr").path(frame);
            const bool exists = fs::exists(folder_ / name);
            if (has_all) {
                EXPECT_EQ(exists, GetParam().frames.contains(frame)) << name;
            }
            if (exists) {
                EXPECT_NO_THROW(color(name)) << name;
            }
            EXPECT_EQ(result.out.find(name) != std::string::npos, exists) << "stdout names what was written";
        }
    }
};

TEST_P(BatchFaultTest, HasItsExitCodeAndMessageAndLeavesWholeFilesOnly) {
    const BatchFault& fault = GetParam();
    if (fault.limit_kB > 0 && !kCanLimitMemory)
        GTEST_SKIP() << "the sanitizer needs all of the address space";
    std::optional<SmallDisk> disk;
    if (fault.is_full || fault.is_read_only) {
        disk.emplace(folder_ / "out");
        if (!disk->mounted()) GTEST_SKIP() << "mounting a small file system needs root";
        if (fault.is_full) disk->fill();
        if (fault.is_read_only) {
            ASSERT_TRUE(disk->make_read_only());
        }
    }
    if (fault.prepare) fault.prepare(folder_.path());
    const CommandResult result = run_with_fault();
    EXPECT_TRUE(fault.exit_codes.contains(ExitCode(result.exit_code))) << result.exit_code << result.err;
    if (result.exit_code != 0 || !fault.exit_codes.contains(ExitCode::memory)) {
        EXPECT_TRUE(std::regex_search(result.err, std::regex(fault.message))) << fault.message << "\n"
                                                                              << result.err;
    }
    expect_whole_files_only(result);
}

std::string name_of(const testing::TestParamInfo<BatchFault>& info) {
    return info.param.what;
}
INSTANTIATE_TEST_SUITE_P(OfFrames, BatchFaultTest, testing::ValuesIn(frame_faults()), name_of);
INSTANTIATE_TEST_SUITE_P(OfMachines, BatchFaultTest, testing::ValuesIn(machine_faults()), name_of);
INSTANTIATE_TEST_SUITE_P(OfPlugins, BatchFaultTest, testing::ValuesIn(plugin_faults()), name_of);

}  // namespace
}  // namespace aftershade::test
