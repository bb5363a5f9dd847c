#include "framework/gpu/timer.h"

#include <chrono>
#include <string>
#include <thread>
#include <type_traits>

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

}  // namespace
}  // namespace aftershade::gpu
