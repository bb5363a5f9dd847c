// Which cores llvmpipe's threads keep to, and that they do in a process of its own.
#include "framework/gpu/rasterizer_threads.h"

#include <sched.h>

#include <filesystem>
#include <fstream>
#include <set>

#include "tests/gpu/gpu_test.h"

namespace aftershade::gpu {
namespace {

using Cores = std::vector<std::optional<int>>;

TEST(RasterizerThreads, HaveACoreEachByTheirNumber) {
    EXPECT_EQ(cores_of_threads({"aftershade", "llvmpipe-1", "llvmpipe-0", "disk$0"}, {0, 1}),
              (Cores{std::nullopt, 1, 0, std::nullopt}));
    EXPECT_EQ(cores_of_threads({"llvmpipe-0", "llvmpipe-1", "llvmpipe-2"}, {4, 6, 9}), (Cores{4, 6, 9}));
}

TEST(RasterizerThreads, MoveFreelyWhereTheyAreFewerOrMoreThanTheCores) {
    EXPECT_EQ(cores_of_threads({"llvmpipe-0"}, {3}), Cores(1)) << "nothing to choose";
    EXPECT_EQ(cores_of_threads({"llvmpipe-0", "llvmpipe-1"}, {0, 1, 2}), Cores(2)) << "other processes' core";
    EXPECT_EQ(cores_of_threads({"llvmpipe-0", "llvmpipe-1", "llvmpipe-2"}, {0, 1}), Cores(3));
    EXPECT_EQ(cores_of_threads({"llvmpipe-0", "llvmpipe-1", "llvmpipe-0", "llvmpipe-1"}, {0, 1}), Cores(4))
        << "two renderers";
}

TEST(RasterizerThreads, AreKnownByTheirWholeName) {
    EXPECT_EQ(cores_of_threads({"llvmpipe-0", "llvmpipe-1x", "llvmpipe-", "llvmpipe", "Llvmpipe-1"}, {0, 1}),
              Cores(5));
}

/// Ends the process: 0 where a tested context's threads each keep to another core.
[[noreturn]] void end_as_spread(SelfTest when) {
    Context context(Backend::software, when);
    context.test_once();
    std::set<int> found;
    int threads = 0;
    for (const auto& task : std::filesystem::directory_iterator("/proc/self/task")) {
        std::ifstream file(task.path() / "comm");
        std::string name;
        std::getline(file, name);
        if (!name.starts_with("llvmpipe-")) continue;
        ++threads;
        cpu_set_t set;
        sched_getaffinity(std::stoi(task.path().filename().string()), sizeof set, &set);
        for (int core = 0; core < CPU_SETSIZE && CPU_COUNT(&set) == 1; ++core)
            if (CPU_ISSET(core, &set)) found.insert(core);
    }
    std::fprintf(stderr, "%d threads on %zu cores\n", threads, found.size());
    _exit(threads > 1 && std::size_t(threads) == found.size() ? 0 : 1);
}

TEST(RasterizerThreads, OfAContextKeepToThem) {
    cpu_set_t set;
    ASSERT_EQ(sched_getaffinity(0, sizeof set, &set), 0);
    if (CPU_COUNT(&set) < 2 || CPU_COUNT(&set) > 8) GTEST_SKIP() << CPU_COUNT(&set) << " cores";
    GTEST_FLAG_SET(death_test_style, "threadsafe");
    setenv("LP_NUM_THREADS", std::to_string(CPU_COUNT(&set)).c_str(), 1);
    for (const SelfTest when : {SelfTest::now, SelfTest::at_first_use})
        EXPECT_EXIT(end_as_spread(when), testing::ExitedWithCode(0), "threads on");
    unsetenv("LP_NUM_THREADS");
}

}  // namespace
}  // namespace aftershade::gpu
