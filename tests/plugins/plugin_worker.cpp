// A process that prepares one frame of one plug-in, or does as a word says: what tests run as a worker.
//   plugin_worker FOLDER EFFECT      plugin_worker --allocate | --spin | --sleep | --orphan | --talk
#include <unistd.h>

#include <cstdio>
#include <new>
#include <string>
#include <vector>

#include "framework/core/error.h"
#include "framework/effect/native/native_effect.h"
#include "framework/effect/native/native_library.h"

namespace {

int prepare(const char* folder, const char* effect) {
    using namespace aftershade;
    StatusWriter status;
    NativeRegistry registry({folder}, {}, &status);
    NativeEffect native(registry, {effect, "1.0.0", {{"gain", {}}}, {}, {}}, "grade", &status);
    ParamSpec spec;
    spec.name = "gain";
    const std::vector<ParamSpec> specs = {spec};
    ParamSet values;
    values.set("gain", 0.5);
    NativeFrame frame;
    frame.specs = &specs;
    frame.params = &values;
    frame.number = 12;
    native.prepare(frame);
    std::puts("prepared");
    return 0;
}

int act(const std::string& what) {
    if (what == "--allocate") {
        std::vector<char> all(std::size_t(4) << 30, 1);
        asm volatile("" : : "r"(all.data()) : "memory");  // or the compiler may leave the allocation out
        return all.back();
    }
    volatile unsigned long spins = 0;
    while (what == "--spin") spins = spins + 1;
    if (what == "--orphan" && fork() != 0) return 0;  // the child of the child stays behind, with our pipes
    if (what == "--orphan" || what == "--sleep") sleep(60);
    if (what == "--talk") {
        std::puts("one\n");
        std::fputs("to stderr\n", stderr);
        std::fputs("no line end", stdout);
    }
    return 7;
}

}  // namespace

int main(int count, char** arguments) try {
    return count == 3 ? prepare(arguments[1], arguments[2]) : act(count > 1 ? arguments[1] : "");
} catch (const aftershade::Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return int(error.exit_code());
} catch (const std::bad_alloc&) {
    std::fputs("out of memory\n", stderr);
    return 5;
}
