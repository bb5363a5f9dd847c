// `aftershade warm`: caches that a later run finds.
#include <gtest/gtest.h>
#include <sched.h>

#include <algorithm>
#include <filesystem>
#include <set>
#include <string>

#include "tests/backends.h"
#include "tests/cli/command.h"
#include "tests/cli/small_disk.h"

namespace aftershade::test {
namespace {

namespace fs = std::filesystem;

const std::string kWarmLook = AFTERSHADE_SOURCE_DIR "/scenes/looks/portrait.json";
const std::string kWarmCapture = AFTERSHADE_SOURCE_DIR "/scenes/suzanne/capture.json";

std::set<fs::path> files_below(const fs::path& folder) {
    std::set<fs::path> files;
    for (const auto& entry : fs::recursive_directory_iterator(folder))
        if (entry.is_regular_file()) files.insert(entry.path());
    return files;
}

class Warm : public ::testing::Test {
protected:
    CommandResult run(const std::vector<std::string>& words, const std::string& cache) {
        std::vector<std::string> all{AFTERSHADE_EXECUTABLE};
        all.insert(all.end(), words.begin(), words.end());
        return Command(all, folder_.path(), {{"AFTERSHADE_CACHE", cache}}).wait();
    }
    TemporaryFolder folder_;
};

/// In a folder "mesa_shader_cache", of Mesa 24 and 25.0 "mesa_shader_cache_db".
bool has_mesas_code(const fs::path& cache) {
    return fs::is_directory(cache) &&
           std::ranges::any_of(fs::directory_iterator(cache), [](const fs::directory_entry& entry) {
               return entry.path().filename().string().starts_with("mesa_shader_cache");
           });
}

TEST_F(Warm, LeavesNothingForALaterRunToCompile) {
    const fs::path cache = folder_ / "cache";
    const CommandResult warmed =
        run({"warm", kWarmLook, kWarmCapture, "--frames", "4", "--backend", "software"}, cache.string());
    ASSERT_EQ(warmed.exit_code, 0) << warmed.err;
    EXPECT_NE(warmed.out.find(cache.string()), std::string::npos) << warmed.out;
    const std::set<fs::path> after_warm = files_below(cache);
    EXPECT_TRUE(has_mesas_code(cache)) << "Mesa's code lies in the same folder";
    using Words = std::vector<std::string>;
    for (const Words& outputs : {Words{"-o", "o_####.exr"}, Words{"-o", "o_####.png"},
                                 Words{"-o", "o_####.exr", "-o", "o_####.png"}}) {
        Words words{"run", kWarmLook, kWarmCapture, "--frames", "4", "--backend", "software", "--overwrite"};
        words.insert(words.end(), outputs.begin(), outputs.end());
        const CommandResult ran = run(words, cache.string());
        ASSERT_EQ(ran.exit_code, 0) << ran.err;
        EXPECT_EQ(files_below(cache), after_warm)
            << "the run compiled something that warm had not: " << outputs[1];
    }
}

TEST_F(Warm, FailsWhereTheCacheIsOffOrTheLookIsFaulty) {
    const CommandResult off = run({"warm", kWarmLook, kWarmCapture}, "off");
    EXPECT_EQ(off.exit_code, 2);
    EXPECT_NE(off.err.find("the cache is off"), std::string::npos) << off.err;
    write_text(folder_ / "look.json", R"({ "aftershade": 1, "steps": [{ "effect": "blom" }] })");
    const CommandResult faulty = run({"warm", "look.json", kWarmCapture}, (folder_ / "cache").string());
    EXPECT_EQ(faulty.exit_code, 2);
    EXPECT_NE(faulty.err.find("blom"), std::string::npos) << faulty.err;
    EXPECT_FALSE(has_mesas_code(folder_ / "cache")) << "nothing was compiled";
}

TEST_F(Warm, FailsWithTheReasonWhereNothingCanBeKept) {
    write_text(folder_ / "look.json", R"({ "aftershade": 1, "steps": [{ "effect": "view_transform" }] })");
    const SmallDisk full(folder_ / "full");
    if (full.mounted()) full.fill();
    std::vector<std::pair<std::string, std::string>> places{{"/dev/null", "directory"}};
    if (full.mounted()) places.emplace_back((folder_ / "full").string(), "No space left on device");
    for (const auto& [cache, reason] : places) {
        const CommandResult warmed =
            run({"warm", "look.json", kWarmCapture, "--frames", "4", "--backend", "software"}, cache);
        EXPECT_EQ(warmed.exit_code, 6) << warmed.err;
        EXPECT_NE(warmed.err.find("nothing can be cached: " + cache), std::string::npos) << warmed.err;
        EXPECT_NE(warmed.err.find(reason), std::string::npos) << warmed.err;
    }
}

TEST_F(Warm, IsNotNeededWhereTheDiskOfTheCacheIsFull) {
    const SmallDisk full(folder_ / "full");
    if (!full.mounted()) GTEST_SKIP() << "needs the right to mount";
    full.fill();
    write_text(folder_ / "look.json", R"({ "aftershade": 1, "steps": [{ "effect": "view_transform" }] })");
    const std::string cache = (folder_ / "full").string();
    for (const std::vector<std::string>& more : std::vector<std::vector<std::string>>{{}, {"--jobs", "2"}}) {
        std::vector<std::string> words{"run", "look.json",  kWarmCapture, "--frames", "4",
                                       "-o",  "o_####.exr", "--backend",  "software", "--overwrite"};
        words.insert(words.end(), more.begin(), more.end());
        const CommandResult ran = run(words, cache);
        EXPECT_EQ(ran.exit_code, 0) << ran.err;
    }
    const CommandResult doctor = run({"doctor"}, cache);
    EXPECT_EQ(doctor.exit_code, 0) << doctor.err;
    EXPECT_NE(doctor.out.find("shader cache  off: " + cache), std::string::npos) << doctor.out;
}

/// This process and those that it starts on one processor.
class OneProcessor {
public:
    OneProcessor() {
        sched_getaffinity(0, sizeof found_, &found_);
        cpu_set_t one;
        CPU_ZERO(&one);
        for (int i = 0; i < CPU_SETSIZE && CPU_COUNT(&one) == 0; ++i)
            if (CPU_ISSET(i, &found_)) CPU_SET(i, &one);
        sched_setaffinity(0, sizeof one, &one);
    }
    ~OneProcessor() { sched_setaffinity(0, sizeof found_, &found_); }
    OneProcessor(const OneProcessor&) = delete;
    OneProcessor& operator=(const OneProcessor&) = delete;
    int processors_found() const { return CPU_COUNT(&found_); }

private:
    cpu_set_t found_{};
};

TEST_F(Warm, ThreadsCompileWhatTheFrameNeedsAndNothingElse) {
    // Mesa's cache has one file for each machine code: a pass that the threads draw in another state than the
    // frame does would leave one more. Its names hang on the number of processors. The second run writes what
    // the end of the first one may have cut off.
    const auto files_after_runs = [&](const std::string& backend, const std::string& name) {
        const fs::path cache = folder_ / (backend + name);
        for (int i = 0; i < 2; ++i) {
            const CommandResult ran =
                run({"run", AFTERSHADE_SOURCE_DIR "/scenes/looks/film.json", kWarmCapture, "--frames", "4",
                     "--backend", backend, "--overwrite", "-o", "o_####.exr"},
                    cache.string());
            EXPECT_EQ(ran.exit_code, 0) << ran.err;
        }
        return files_below(cache).size();
    };
    for (const char* backend : {"osmesa", "egl-software"}) {
        if (!gpu::why_not(*gpu::parse_backend(backend)).empty()) continue;
        std::size_t alone = 0;
        {
            const OneProcessor one;
            if (one.processors_found() < 2) GTEST_SKIP() << "SKIPPED: one processor compiles without threads";
            alone = files_after_runs(backend, "alone");
        }
        EXPECT_EQ(files_after_runs(backend, "threads"), alone) << backend;
    }
}

}  // namespace
}  // namespace aftershade::test
