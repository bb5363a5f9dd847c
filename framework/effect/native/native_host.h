// The host's side of aftershade_host, and of calls into plug-ins: internal to framework/effect.
#pragma once

#include <fenv.h>

#include <exception>
#include <functional>
#include <mutex>
#include <string>
#include <vector>

#include "framework/base/error.h"
#include "framework/effect/native/native_types.h"
#include "framework/plugin/aftershade_plugin.h"

namespace aftershade {

/// The aftershade_host of a library or an instance. Never moved: plug-ins keep its address.
class NativeHost {
public:
    NativeHost();
    NativeHost(const NativeHost&) = delete;
    NativeHost& operator=(const NativeHost&) = delete;

    const aftershade_host* get() const { return &host_; }
    /// Text of set_error since the last call, or "". [thread-safe]
    std::string take_error();
    /// Lines logged since the last call. [thread-safe]
    std::vector<NativeLogLine> take_log();

private:
    static void log(const aftershade_host* host, aftershade_log_level level, const char* message) noexcept;
    static void set_error(const aftershade_host* host, const char* message) noexcept;
    static const void* get_extension(const aftershade_host* host, const char* id) noexcept;

    aftershade_host host_{};
    std::mutex mutex_;
    std::string error_;
    std::vector<NativeLogLine> lines_;
};

/// Calls into a plug-in. A C++ exception becomes an Error that begins with `what`; rounding mode and denormal
/// handling, which change every number computed later, are put back.
template <class Call>
auto call_plugin(const std::string& what, Call&& call) {
    struct Environment {
        fenv_t saved;
        Environment() { fegetenv(&saved); }
        ~Environment() { fesetenv(&saved); }
    } environment;
    try {
        return call();
    } catch (const std::exception& exception) {
        throw Error(ErrorKind::effect, what + " threw an exception: " + exception.what());
    } catch (...) {
        throw Error(ErrorKind::effect, what + " threw an exception of a type other than std::exception");
    }
}

}  // namespace aftershade
