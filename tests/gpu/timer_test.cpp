#include "framework/gpu/timer.h"

#include <chrono>
#include <string>
#include <thread>
#include <type_traits>
#include <utility>
#include <vector>

#include "framework/gpu/context_internal.h"
#include "tests/gpu/gpu_test.h"

namespace aftershade::gpu {
namespace {

static_assert(!std::is_copy_constructible_v<Timer> && !std::is_move_constructible_v<Timer>);

class TimerOn : public SoftwareTest {};
ON_EACH_BACKEND(TimerOn);

TEST_P(TimerOn, MeasuresWallTimeOnEachBackend) {
    EXPECT_EQ(std::string(Timer::clock_name(context())), "wall");
    Timer timer(context());
    timer.start();
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    const double slept_ms = timer.stop_ms();
    EXPECT_GE(slept_ms, 20.0);
    EXPECT_LT(slept_ms, 5000.0);
}

TEST_P(TimerOn, AsksAGpuForTimesOnlyWhenTheyAreWanted) {
    const bool is_software = std::exchange(
        context().impl().info.software, false);  // the way of hardware, whose queries llvmpipe answers, too
    std::size_t made = 0;
    for (int frame = 0; frame < 3; ++frame) {
        Timer timer(context());
        std::vector<Duration> durations;
        for (int pass = 0; pass < 5; ++pass) {
            timer.start();
            texture(64, 64).clear(1);
            durations.push_back(timer.stop());
        }
        timer.start();         // and never stopped
        durations.pop_back();  // no one asks for it
        for (Duration& duration : durations) {
            const double ms = duration.ms();
            EXPECT_GE(ms, 0);
            EXPECT_LT(ms, 5000);
            EXPECT_EQ(duration.ms(), ms) << "it is kept";
        }
        if (frame == 0) made = context().impl().queries_made;
    }
    EXPECT_EQ(made, 11U);
    EXPECT_EQ(context().impl().queries_made, made) << "queries are used again";
    EXPECT_EQ(context().impl().free_queries.size(), made);
    context().check("queries");
    context().impl().info.software = is_software;
}

}  // namespace
}  // namespace aftershade::gpu
