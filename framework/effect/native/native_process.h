// Untrusted native code in a process of its own, confined by the kernel.
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "framework/base/status.h"
#include "framework/effect/native/confinement.h"
#include "framework/effect/native/native_types.h"

namespace aftershade {

struct NativeProcessOptions {
    /// Starts a program that calls serve_native_code() and does nothing before.
    std::vector<std::string> command;
    std::chrono::duration<double> timeout{60};  ///< of one call of a plug-in, whatever it prints
    std::optional<std::uint64_t> memory_bytes;  ///< of address space
    bool warns = true;                          ///< of what the kernel does not prevent, on standard error
};

/// Starts the process with the first call, and again with the first one after it has ended; instances end
/// with it. It has none of this process's files and few of its variables, and dies with the thread that
/// started it. Text that plug-ins print goes to standard error, up to a limit. Throws
/// Error(ErrorKind::effect), where a plug-in fails, crashes, ends the process or takes too long, naming it
/// and the call. [one thread at a time]
class NativeProcess {
public:
    explicit NativeProcess(NativeProcessOptions options);
    ~NativeProcess();
    NativeProcess(const NativeProcess&) = delete;
    NativeProcess& operator=(const NativeProcess&) = delete;

    /// The effects of a library.
    struct Offer {
        std::string contact;
        std::vector<std::pair<std::string, std::string>> effects;  ///< ids and versions
    };
    Offer open(const std::filesystem::path& library);

    /// A number for the instance.
    int create(const std::filesystem::path& library, const NativeDeclaration& declaration,
               const std::string& step);
    /// The received values are checked against the declaration again: the process may lie.
    NativeResult prepare(int instance, const NativeFrame& frame);
    void reset(int instance);
    void destroy(int instance);

    /// The confinement of the process by the kernel; starts the process if it does not run.
    const Confinement& held();

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

/// The other side, in the child: confines it, then answers until this process goes. `descriptor` is the
/// stream to it. Returns the exit code.
int serve_native_code(int descriptor);

/// The descriptor that a process of native code is started with.
inline constexpr int kNativeDescriptor = 3;

}  // namespace aftershade
