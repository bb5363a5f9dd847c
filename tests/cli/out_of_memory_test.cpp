// A limit of the address space, as farms set it: a picture or exit 7, never a crash.
#include "framework/batch/process_codes.h"
#include "tests/backends.h"
#include "tests/cli/batch_work.h"

namespace aftershade::test {
namespace {

namespace fs = std::filesystem;

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool kCanLimit = false;  // the sanitizer reserves terabytes of address space
#else
constexpr bool kCanLimit = true;
#endif

/// What the page on exit codes promises to be enough for a frame of 480 x 270.
constexpr int kEnough_kB = 500'000;

struct Limit {
    int kilobytes = 0;
    std::string backend;
};
void PrintTo(const Limit& limit, std::ostream* out) {
    *out << limit.kilobytes << " kB, " << limit.backend;
}

std::vector<Limit> limits() {
    std::vector<Limit> all;
    for (int kilobytes = 100'000; kilobytes <= 1'000'000; kilobytes += kilobytes < 250'000 ? 75'000 : 50'000)
        for (const char* backend : {"osmesa", "egl-software"}) all.push_back({kilobytes, backend});
    return all;
}

class MemoryLimit : public BatchWork, public testing::WithParamInterface<Limit> {
protected:
    CommandResult limited(const std::string& look, const std::string& out) const {
        const std::string script =
            "ulimit -c 0; ulimit -v " + std::to_string(GetParam().kilobytes) + "; exec \"$0\" \"$@\"";
        return Command({"/bin/sh", "-c", script, AFTERSHADE_EXECUTABLE, "run", look, "in_0001.exr", "-o", out,
                        "--backend", GetParam().backend},
                       folder_.path())
            .wait();
    }
};

TEST_P(MemoryLimit, GivesThePictureOrTheExitOfItsOwn) {
    SKIP_WITHOUT(*gpu::parse_backend(GetParam().backend));
    if (!kCanLimit) GTEST_SKIP() << "the address sanitizer needs all of the address space";
    write_frames(1, 1, 480, 270);
    write_text(folder_ / "bokeh.json", R"({ "aftershade": 1, "steps": [ { "effect": "bokeh" } ] })");
    const int attempts = GetParam().kilobytes % 100'000 == 0 ? 3 : 1;
    for (int attempt = 0; attempt < attempts; ++attempt) {  // threads take memory in another order each time
        const CommandResult result = limited("bokeh.json", "out.exr");
        if (result.exit_code == 0) {
            EXPECT_NO_THROW(color("out.exr"));
        } else {
            EXPECT_EQ(result.exit_code, int(ExitCode::memory)) << result.err;
            EXPECT_NE(result.err.find("out of memory"), std::string::npos) << result.err;
            EXPECT_NE(result.err.find("ulimit -v"), std::string::npos) << result.err;
            EXPECT_FALSE(fs::exists(folder_ / "out.exr"));
        }
        EXPECT_TRUE(result.exit_code == 0 || GetParam().kilobytes < kEnough_kB) << result.err;
        fs::remove(folder_ / "out.exr");
    }
}

INSTANTIATE_TEST_SUITE_P(Of, MemoryLimit, testing::ValuesIn(limits()), [](const auto& limit) {
    return std::to_string(limit.param.kilobytes) + (limit.param.backend == "osmesa" ? "_osmesa" : "_egl");
});

class OutOfMemory : public BatchWork {};

TEST_F(OutOfMemory, ALimitOfDataIsMetAsOneOfTheAddressSpace) {
    if (!kCanLimit) GTEST_SKIP() << "the address sanitizer needs all of the address space";
    write_frames(1, 1, 64, 36);
    for (const int kilobytes : {3'000, 32'000, 64'000, 128'000, 256'000, 1'000'000}) {
        const CommandResult result =
            Command({"/bin/sh", "-c",
                     "ulimit -c 0; ulimit -d " + std::to_string(kilobytes) + "; exec \"$0\" \"$@\"",
                     AFTERSHADE_EXECUTABLE, "run", "nothing.json", "in_0001.exr", "-o", "out.exr",
                     "--overwrite", "--backend", "software"},
                    folder_.path())
                .wait();
        EXPECT_EQ(result.exit_code, kilobytes < 500'000 ? int(ExitCode::memory) : 0)
            << kilobytes << result.err;
        EXPECT_TRUE(result.exit_code == 0 || result.err.find("ulimit -d") != std::string::npos) << result.err;
    }
}

TEST_F(OutOfMemory, AFrameThatDoesNotFitIsNoDamagedFile) {
    if (!kCanLimit) GTEST_SKIP() << "the address sanitizer needs all of the address space";
    write_frames(1, 1, 4096, 2160);  // 35 MB a channel
    const CommandResult result =
        Command({"/bin/sh", "-c", "ulimit -c 0; ulimit -v 700000; exec \"$0\" \"$@\"", AFTERSHADE_EXECUTABLE,
                 "run", "spread.json", "in_0001.exr", "-o", "out.exr", "--effect-path", "effects",
                 "--backend", "software"},
                folder_.path())
            .wait();
    EXPECT_EQ(result.exit_code, int(ExitCode::memory)) << result.err;
    EXPECT_EQ(result.err.find("damaged"), std::string::npos) << result.err;
    EXPECT_NE(result.err.find("out of memory"), std::string::npos) << result.err;
    EXPECT_TRUE(temporaries().empty());
}

}  // namespace
}  // namespace aftershade::test
