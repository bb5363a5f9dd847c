// A forked child renders, or raises at once: it never waits for threads that only its parent has.
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <exception>
#include <functional>
#include <optional>
#include <string>
#include <thread>

#include <gtest/gtest.h>

#include "aftershade/compare.h"
#include "aftershade/host.h"
#include "tests/host/host_setup.h"

namespace {

using namespace aftershade::host;
using namespace aftershade::test;

constexpr const char* kVignette = R"({"aftershade": 1, "steps": [{"effect": "vignette"}]})";
/// A child that waits for ever ends by this alarm. Sanitizers and Valgrind render slowly.
constexpr unsigned kAlarm_s = 60;

/// What `work` returns in a forked child; "signal 14" where it waited for ever.
std::string in_child(const std::function<std::string()>& work) {
    int ends[2];
    if (pipe(ends) != 0) return "no pipe";
    const pid_t child = fork();
    if (child == 0) {
        alarm(kAlarm_s);
        std::string text;
        // Past an exception the child would go on with the tests of its parent.
        try {
            text = work();
        } catch (const std::exception& error) {
            text = std::string("threw: ") + error.what();
        }
        const bool is_sent = write(ends[1], text.data(), text.size()) == ssize_t(text.size());
        _exit(is_sent ? 0 : 1);
    }
    close(ends[1]);
    std::string text;
    char part[512];
    for (ssize_t count = 0; (count = read(ends[0], part, sizeof part)) > 0;)
        text.append(part, std::size_t(count));
    close(ends[0]);
    int status = 0;
    waitpid(child, &status, 0);
    return WIFSIGNALED(status) ? "signal " + std::to_string(WTERMSIG(status)) : text;
}

std::string outcome(const std::function<void()>& work) {
    try {
        work();
        return "done";
    } catch (const Error& error) {
        return error_kind_name(error.kind()) + std::string(": ") + error.what();
    }
}

void render_once() {
    Host host(on_software());
    host.parse_look(kVignette).render(small_capture());
}

void expect_refusal(const std::string& found) {
    EXPECT_TRUE(found.starts_with("usage: ")) << found;
    EXPECT_NE(found.find("was forked"), std::string::npos) << found;
    EXPECT_NE(found.find("get_context(\"spawn\")"), std::string::npos) << found;
}

// What a test draws, the children of the next one would inherit: this process itself makes no context.
std::string in_fresh_process(const std::function<std::string()>& work) {
    return in_child(work);
}

TEST(Fork, AChildOfAProcessWithoutAContextRenders) {
    const std::string found = in_fresh_process([] {
        Host host(on_software());
        Look look = host.parse_look(kVignette);
        return in_child(
            [&] { return outcome([&] { look.render(small_capture()); }) + ", " + outcome(render_once); });
    });
    EXPECT_EQ(found, "done, done");
}

TEST(Fork, AfterARenderTheParentsLookRaisesInTheChild) {
    expect_refusal(in_fresh_process([] {
        Host host(on_software());
        Look look = host.parse_look(kVignette);
        look.render(small_capture());
        return in_child([&] { return outcome([&] { look.render(small_capture()); }); });
    }));
}

TEST(Fork, AfterARenderAHostOfTheChildsOwnRaises) {
    expect_refusal(in_fresh_process([] {
        render_once();
        return in_child([] { return outcome(render_once); });
    }));
}

TEST(Fork, AGrandchildRaisesToo) {
    expect_refusal(in_fresh_process([] {
        render_once();
        return in_child([] { return in_child([] { return outcome(render_once); }); });
    }));
}

TEST(Fork, TheChildMayDestroyWhatTheParentMade) {
    const std::string found = in_fresh_process([] {
        auto host = std::make_optional<Host>(on_software());
        auto look = std::make_optional(host->parse_look(kBlurLook));
        auto session = std::make_optional(look->session());
        look->render(small_capture());
        session->render(small_capture());
        return in_child([&] {
            session.reset();
            host->detach();
            host->close();
            look.reset();
            host.reset();
            return std::string("destroyed");
        });
    });
    EXPECT_EQ(found, "destroyed");
}

TEST(Fork, AChildRaisesWhileAnotherThreadOfTheParentRenders) {
    const std::string found = in_fresh_process([] {
        std::atomic<bool> is_drawing = false, stops = false;
        std::thread other([&] {
            Host host(on_software());
            Look look = host.parse_look(kBlurLook);
            while (!stops) {
                look.render(small_capture());
                is_drawing = true;
            }
        });
        while (!is_drawing) std::this_thread::yield();
        std::string all;
        for (int i = 0; i < 8; ++i) all = in_child([] { return outcome(render_once); });
        stops = true;
        other.join();
        return all;
    });
    expect_refusal(found);
}

TEST(Fork, TheParentRendersTheSameBitsAfterItsChildren) {
    const std::string found = in_fresh_process([] {
        Host host(on_software());
        Look look = host.parse_look(kBlurLook);
        const Image before = look.render(small_capture()).image("color");
        in_child([&] { return outcome([&] { look.render(small_capture()); }); });
        const bool is_same = same_bits(look.render(small_capture()).image("color"), before);
        return std::string(is_same ? "same" : "other");
    });
    EXPECT_EQ(found, "same");
}

TEST(Fork, AChildComparesAndReadsAResultWithoutOpenGl) {
    const std::string found = in_fresh_process([] {
        Host host(on_software());
        const Result result = host.parse_look(kVignette).render(small_capture());
        return in_child([&] {
            const Image image = result.image("color");
            return std::string(verdict_name(compare(image, image).verdict));
        });
    });
    EXPECT_EQ(found, "same");
}

}  // namespace
