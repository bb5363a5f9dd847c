#include "framework/base/cores.h"

#include <gtest/gtest.h>
#include <sched.h>

#include <cmath>
#include <filesystem>
#include <thread>

#include "tests/temporary_folder.h"

namespace aftershade {
namespace {

using test::TemporaryFolder;

TEST(Cores, AreThoseOfTheAffinityMask) {
    int alone = 0;
    std::thread([&] {
        cpu_set_t all, one;
        sched_getaffinity(0, sizeof all, &all);
        CPU_ZERO(&one);
        for (int core = 0; core < CPU_SETSIZE && CPU_COUNT(&one) == 0; ++core)
            if (CPU_ISSET(core, &all)) CPU_SET(core, &one);
        sched_setaffinity(0, sizeof one, &one);
        alone = allotted_cores();
    }).join();
    EXPECT_EQ(alone, 1);
    EXPECT_GE(allotted_cores(), 1);
}

TEST(Cores, OfAControlGroupAreTheLeastOfItAndThoseAbove) {
    const TemporaryFolder folder;
    std::filesystem::create_directories(folder / "farm/job");
    test::write_text(folder / "farm/cpu.max", "150000 100000\n");
    test::write_text(folder / "farm/job/cpu.max", "max 100000\n");
    EXPECT_EQ(granted_cores("0::/farm/job\n", folder.path()), 1.5);
    test::write_text(folder / "farm/job/cpu.max", "50000 100000\n");
    EXPECT_EQ(granted_cores("0::/farm/job\n", folder.path()), 0.5);
    EXPECT_TRUE(std::isinf(granted_cores("0::/\n", folder.path())));
}

TEST(Cores, OfAContainerAreThoseOfTheRoot) {
    const TemporaryFolder folder;
    test::write_text(folder / "cpu.max", "200000 100000\n");
    EXPECT_EQ(granted_cores("0::/../../docker/1f\n", folder.path()), 2);
}

TEST(Cores, OfVersion1AreQuotaOverPeriod) {
    const TemporaryFolder folder;
    std::filesystem::create_directories(folder / "cpu,cpuacct/docker");
    test::write_text(folder / "cpu,cpuacct/docker/cpu.cfs_quota_us", "300000\n");
    test::write_text(folder / "cpu,cpuacct/docker/cpu.cfs_period_us", "100000\n");
    EXPECT_EQ(granted_cores("7:memory:/docker\n4:cpu,cpuacct:/docker\n", folder.path()), 3);
    test::write_text(folder / "cpu,cpuacct/docker/cpu.cfs_quota_us", "-1\n");
    EXPECT_TRUE(std::isinf(granted_cores("4:cpu,cpuacct:/docker\n", folder.path())));
}

TEST(ControlGroups, LimitMemoryAndThreadsByTheLeastOfThemAndThoseAbove) {
    const TemporaryFolder folder;
    std::filesystem::create_directories(folder / "farm/job");
    test::write_text(folder / "farm/memory.max", "2000000000\n");
    test::write_text(folder / "farm/job/memory.max", "max\n");
    test::write_text(folder / "farm/job/pids.max", "300\n");
    const GroupLimits limits = group_limits("0::/farm/job\n", folder.path());
    EXPECT_EQ(limits.memory_bytes, 2e9);
    EXPECT_EQ(limits.threads, 300);
    EXPECT_TRUE(std::isinf(group_limits("0::/farm\n", folder.path()).threads));
    std::filesystem::create_directories(folder / "memory/job");
    test::write_text(folder / "memory/job/memory.limit_in_bytes", "1000000000\n");
    test::write_text(folder / "memory/memory.limit_in_bytes", "9223372036854771712\n");
    EXPECT_EQ(group_limits("4:memory:/job\n", folder.path()).memory_bytes, 1e9);
    EXPECT_TRUE(std::isinf(group_limits("4:memory:/\n", folder.path()).memory_bytes));
}

}  // namespace
}  // namespace aftershade
