// Hosts side by side: what one gives does not depend on the others.
#include <malloc.h>
#include <unistd.h>

#include <fstream>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "aftershade/host.h"
#include "tests/host/host_setup.h"

namespace {

using namespace aftershade::host;
using namespace aftershade::test;

constexpr int kFrames = 50;

std::string look_of_thread(int thread) {
    const char* const steps[] = {R"({"effect": "bokeh", "params": {"f_number": 0.3, "focus_distance": 2}})",
                                 R"({"effect": "vignette"}, {"effect": "sharpen"})", R"({"effect": "bloom"})",
                                 R"({"effect": "film_grain"})"};
    return std::string(R"({"aftershade": 1, "steps": [)") + steps[thread] + "]}";
}

/// Every frame of a look on a host of its own; small, so that threads meet often.
std::vector<Image> frames_of(int thread, const HostOptions& options) {
    Host host(options);
    Session session = host.parse_look(look_of_thread(thread)).session();
    std::vector<Image> frames;
    for (int frame = 1; frame <= kFrames; ++frame) {
        Capture capture = small_capture(32, 24, 1 + 0.01f * float(frame));
        capture.set_frame(frame);
        frames.push_back(session.render(capture).image("color"));
    }
    return frames;
}

void expect_bits_of_one_alone(const HostOptions& options) {
    std::vector<std::vector<Image>> alone(4), together(4);
    for (int i = 0; i < 4; ++i) alone[std::size_t(i)] = frames_of(i, options);
    std::vector<std::thread> threads;
    for (int i = 0; i < 4; ++i)
        threads.emplace_back([&, i] { together[std::size_t(i)] = frames_of(i, options); });
    for (std::thread& thread : threads) thread.join();
    for (std::size_t i = 0; i < 4; ++i) {
        ASSERT_EQ(together[i].size(), std::size_t(kFrames));
        for (std::size_t frame = 0; frame < together[i].size(); ++frame)
            ASSERT_TRUE(same_bits(together[i][frame], alone[i][frame]))
                << "thread " << i << ", frame " << frame;
    }
}

TEST(HostThreads, FourHostsGiveTheBitsOfOneAlone) {
    expect_bits_of_one_alone(on_software());
}

TEST(HostThreads, FourHostsOnEglGiveTheBitsOfOneAlone) {
    HostOptions options = on_software();
    options.backend = Backend::egl_software;
    expect_bits_of_one_alone(options);
}

TEST(HostThreads, TwoHostsTakeTurnsInOneThread) {
    HostOptions on_egl = on_software();
    on_egl.backend = Backend::egl_software;
    Host first(on_software()), second(on_egl);
    Look blur = first.parse_look(look_of_thread(0)), grain = second.parse_look(look_of_thread(3));
    const Image blurred = blur.render(small_capture()).image("color");
    const Image grained = grain.render(small_capture()).image("color");
    for (int i = 0; i < 5; ++i) {
        EXPECT_TRUE(same_bits(blur.render(small_capture()).image("color"), blurred));
        EXPECT_TRUE(same_bits(grain.render(small_capture()).image("color"), grained));
    }
}

TEST(HostThreads, ADetachedHostWorksInTheThreadThatCallsNext) {
    Host host(on_software());
    Look look = host.parse_look(look_of_thread(0));
    const Image here = look.render(small_capture()).image("color");
    host.detach();
    std::optional<Image> there;
    std::thread([&] {
        there = look.render(small_capture()).image("color");
        host.detach();
    }).join();
    EXPECT_TRUE(same_bits(here, *there));
    EXPECT_TRUE(same_bits(look.render(small_capture()).image("color"), here));
}

TEST(HostThreads, LooksMayDieOnAnyThreadAndAfterTheirHost) {
    std::optional<Look> last;
    {
        Host host(on_software());
        last.emplace(host.parse_look(look_of_thread(0)));
        last->render(small_capture());
        std::optional<Look> other(host.parse_look(look_of_thread(1)));
        other->render(small_capture());
        std::thread([&] { other.reset(); }).join();
        EXPECT_NO_THROW(last->render(small_capture()));
    }
    EXPECT_THROW(last->render(small_capture()), Error);
}

std::size_t resident_bytes() {
    malloc_trim(0);
    std::ifstream statm("/proc/self/statm");
    std::size_t total = 0, resident = 0;
    statm >> total >> resident;
    return resident * std::size_t(sysconf(_SC_PAGESIZE));
}

TEST(HostThreads, MemoryIsFlatOverManyFrames) {
    Host host(on_software());
    Look look = host.parse_look(look_of_thread(0));
    std::size_t early = 0;
    for (int frame = 1; frame <= 150; ++frame) {
        look.set("bokeh.f_number", 0.3 + 0.001 * frame);
        look.render(small_capture(64, 48));
        if (frame == 20) early = resident_bytes();
    }
    // 64 x 48 px of color in floats are 49 kB: a frame that was kept would show as 6 MB.
    EXPECT_LT(double(resident_bytes()), double(early) + 2e6);
}

}  // namespace
