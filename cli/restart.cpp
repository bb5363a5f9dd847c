#include "cli/restart.h"

#include <sys/mman.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string_view>
#include <vector>

#include "cli/command_line.h"
#include "framework/core/error.h"

namespace aftershade::cli {

namespace {

/// The number of a file descriptor. The file has no name, so that nobody else can write to it.
constexpr const char* kVariable = "AFTERSHADE_STATE_FD";

[[noreturn]] void fail() {
    std::fprintf(stderr, "aftershade: error: the server cannot start again: %s\n", std::strerror(errno));
    _exit(int(ExitCode::effect));
}

}  // namespace

void restart(const std::string& state) {
    const int file = memfd_create("aftershade", 0);
    if (file < 0) fail();
    for (std::string_view rest = state; !rest.empty();) {
        const ssize_t written = write(file, rest.data(), rest.size());
        if (written < 0 && errno != EINTR) fail();
        if (written > 0) rest.remove_prefix(std::size_t(written));
    }
    setenv(kVariable, std::to_string(file).c_str(), 1);
    std::vector<std::string> words = own_arguments();
    std::vector<char*> arguments;
    for (std::string& word : words) arguments.push_back(word.data());
    arguments.push_back(nullptr);
    execv("/proc/self/exe", arguments.data());
    fail();
}

std::string state_before_restart() {
    const char* text = std::getenv(kVariable);
    if (!text) return "";
    int file = -1;
    std::from_chars(text, text + std::strlen(text), file);
    unsetenv(kVariable);
    std::string state;
    char bytes[65536];
    for (ssize_t count; (count = pread(file, bytes, sizeof bytes, off_t(state.size()))) > 0;)
        state.append(bytes, std::size_t(count));
    close(file);
    return state;
}

}  // namespace aftershade::cli
