#include "framework/gpu/thread_placement.h"

#include <sched.h>

#include <filesystem>
#include <fstream>
#include <set>
#include <string>

#include "tests/gpu/gpu_test.h"

namespace aftershade::gpu {
namespace {

using Placed = std::vector<std::pair<pid_t, int>>;

TEST(ThreadPlacement, GivesEachThreadACoreOfThoseThatTheProcessMayUse) {
    EXPECT_EQ(placements({{0, 70}, {1, 71}}, {2, 5}), (Placed{{70, 2}, {71, 5}}));
}

TEST(ThreadPlacement, GivesThreadsOfTheSameNumberTheSameCore) {
    EXPECT_EQ(placements({{0, 70}, {1, 71}, {0, 80}, {1, 81}}, {0, 1}),
              (Placed{{70, 0}, {80, 0}, {71, 1}, {81, 1}}));
}

/// Or every process that is limited to a part of the machine's cores would run on the first ones.
TEST(ThreadPlacement, LeavesThreadsAloneWhereThereAreFewerOrMoreThanCores) {
    EXPECT_EQ(placements({{0, 70}}, {0, 1}), Placed());
    EXPECT_EQ(placements({{0, 70}, {1, 71}, {2, 72}}, {0, 1}), Placed());
    EXPECT_EQ(placements({{0, 70}}, {3}), Placed());
    EXPECT_EQ(placements({}, {0, 1}), Placed());
}

class ThreadPlacementOn : public SoftwareTest {};
ON_SOFTWARE_BACKENDS(ThreadPlacementOn);

TEST_P(ThreadPlacementOn, KeepsTheRasterizersThreadsApart) {
    context().finish();
    std::map<std::string, int> cores;  // by the thread's name
    for (const auto& task : std::filesystem::directory_iterator("/proc/self/task")) {
        std::string name;
        std::getline(std::ifstream(task.path() / "comm"), name);
        if (!name.starts_with("llvmpipe-")) continue;
        cpu_set_t set;
        ASSERT_EQ(sched_getaffinity(std::stoi(task.path().filename()), sizeof set, &set), 0);
        for (int core = 0; core < CPU_SETSIZE; ++core)
            if (CPU_ISSET(core, &set)) cores[name] = CPU_COUNT(&set) == 1 ? core : -1;
    }
    cpu_set_t all;
    ASSERT_EQ(sched_getaffinity(0, sizeof all, &all), 0);
    if (CPU_COUNT(&all) < 2 || int(cores.size()) != CPU_COUNT(&all))
        GTEST_SKIP() << cores.size() << " threads on " << CPU_COUNT(&all) << " cores";
    std::set<int> used;
    for (const auto& [name, core] : cores) {
        EXPECT_GE(core, 0) << name << " may run on several cores";
        used.insert(core);
    }
    EXPECT_EQ(used.size(), cores.size());
}

}  // namespace
}  // namespace aftershade::gpu
