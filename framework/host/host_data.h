// The data of a Host, and the frame around each call.
#pragma once

#include <atomic>
#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <thread>
#include <utility>
#include <vector>

#include "aftershade/host.h"
#include "framework/base/data_path.h"
#include "framework/capture/profile.h"
#include "framework/effect/native/native_library.h"
#include "framework/effect/pass_program.h"
#include "framework/effect/registry.h"
#include "framework/gpu/context.h"
#include "framework/gpu/egl_current.h"
#include "framework/gpu/fork_guard.h"
#include "framework/host/failures.h"

namespace aftershade::host {

class Rendering;

struct Host::Data {
    explicit Data(HostOptions given);

    std::filesystem::path glsl() const { return options.data / "glsl"; }
    EffectRegistry registry() const;
    /// Made with the first call. Throws Error(gl).
    gpu::Context& context();
    const std::shared_ptr<ProgramCache>& programs();
    /// Leaves this thread without the context.
    void release() noexcept {
        if (context_) context_->release();
    }
    /// Frees everything of GL, or leaves it to the process's end.
    void close(bool abandons) noexcept;

    /// Read with the first call. Throws Error(document).
    const std::vector<Profile>& profiles();

    const HostOptions options;
    std::unique_ptr<NativeRegistry> natives;
    std::atomic<bool> is_closed = false;

    mutable std::mutex mutex;                 // of what follows
    mutable std::thread::id owner;            // none: whoever calls next
    std::set<Rendering*> renderings;          // with something on the GPU
    std::vector<std::shared_ptr<void>> left;  // by looks and sessions that died on another thread

private:
    std::unique_ptr<gpu::Context> context_;
    std::shared_ptr<ProgramCache> programs_;
    std::optional<std::vector<Profile>> profiles_;
};

/// Stands around the work of one call. [the host's thread]
class Call {
public:
    /// Throws Error(usage) where the host is closed or this is not its thread.
    explicit Call(Host::Data& host);

private:
    DataPathScope data_path_;
    gpu::ForeignContextGuard foreign_;
};

/// Does the work of one call; its errors are of the API.
template <typename Work>
auto called(Host::Data& host, Work work) -> decltype(work()) {
    try {
        gpu::require_not_forked();  // before a lock that a thread of the parent may have held
        const Call call(host);
        return work();
    } catch (...) {
        try {
            rethrow();
        } catch (const Error& error) {
            // Mesa 22.3 may wait for ever in its clean-up after that.
            if (error.kind() == ErrorKind::memory) host.close(true);
            throw;
        }
    }
}

}  // namespace aftershade::host
