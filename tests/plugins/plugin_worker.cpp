// A process that prepares one frame of one plug-in, or does as a word says: what tests run as a worker.
//   plugin_worker FOLDER EFFECT [confined]      plugin_worker --allocate | --spin | --sleep | --orphan |
//   --talk plugin_worker --victim FOLDER
#include <fcntl.h>
#include <linux/futex.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <memory>
#include <new>
#include <string>
#include <string_view>
#include <thread>
#include <utility>
#include <vector>

#include "framework/base/error.h"
#include "framework/batch/process_codes.h"
#include "framework/effect/native/native_effect.h"
#include "framework/effect/native/native_library.h"
#include "framework/effect/native/native_process.h"

namespace {

void block_signals() {
    sigset_t all;
    sigfillset(&all);
    sigdelset(&all, SIGCHLD);  // which the end of a plug-in's process sends
    sigprocmask(SIG_SETMASK, &all, nullptr);
}

/// What a plug-in may have changed of this process, which is its parent or itself.
void print_state() {
    cpu_set_t cpus;
    sched_getaffinity(0, sizeof cpus, &cpus);
    std::printf("parent|%d cpus|priority %d|policy %d|", CPU_COUNT(&cpus), getpriority(PRIO_PROCESS, 0),
                sched_getscheduler(0));
    std::ifstream status("/proc/self/status");
    for (std::string line; std::getline(status, line);)
        if (line.starts_with("ShdPnd") || line.starts_with("SigPnd")) std::printf("%s|", line.c_str());
    std::puts("");
    std::fflush(stdout);
}

int prepare(const char* folder, const char* effect, bool is_confined) {
    using namespace aftershade;
    StatusWriter status;
    std::shared_ptr<NativeProcess> process;
    if (is_confined) {
        NativeProcessOptions options;
        options.command = {"/proc/self/exe", "--native-host"};
        options.memory_bytes = 1u << 30;
        process = std::make_shared<NativeProcess>(std::move(options));
    }
    NativeRegistry registry({folder}, {}, &status, process);
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

/// Has secrets in its environment, in its memory and in an open file without a name, blocks all signals, and
/// waits in the file "shared". Prints its id, and where the secrets are.
int be_victim(const std::string& folder) {
    static char secret[64];
    const char* const given = std::getenv("SECRET");
    std::strncpy(secret, given ? given : "", sizeof secret - 1);
    const int file = open(folder.c_str(), O_TMPFILE | O_RDWR, 0600);
    if (pwrite(file, secret, sizeof secret, 0) < 0) return 1;
    const int shared = open((folder + "/shared").c_str(), O_RDWR);
    void* const word = mmap(nullptr, 4096, PROT_READ | PROT_WRITE, MAP_SHARED, shared, 0);
    if (word == MAP_FAILED) return 1;
    setpgid(0, 0);
    prctl(PR_SET_PTRACER, PR_SET_PTRACER_ANY);  // where Yama lets parents alone trace
    block_signals();
    std::thread([word] {
        for (;;) syscall(SYS_futex, word, FUTEX_WAIT, 0, nullptr, nullptr, 0);
    }).detach();
    std::printf("%d %d %p\n", getpid(), file, static_cast<void*>(secret));
    std::fflush(stdout);
    for (;;) pause();
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
    const std::string_view word = count > 1 ? arguments[1] : "";
    if (word == "--native-host") return aftershade::serve_native_code(aftershade::kNativeDescriptor);
    if (word == "--victim" && count == 3) return be_victim(arguments[2]);
    if (count < 3) return act(std::string(word));
    if (count == 3) return prepare(arguments[1], arguments[2], false);
    block_signals();
    print_state();
    const int code = prepare(arguments[1], arguments[2], std::string_view(arguments[3]) == "confined");
    print_state();
    return code;
} catch (const aftershade::Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return int(aftershade::ExitCode::effect);
} catch (const std::bad_alloc&) {
    std::fputs("out of memory\n", stderr);
    return 5;
}
