// A look over a capture on a page of this machine's browser: `aftershade serve`.
#pragma once

#include <atomic>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "framework/capture/profile.h"
#include "framework/capture/sequence.h"
#include "framework/core/status.h"
#include "framework/file/exr_file.h"
#include "framework/gpu/context.h"

namespace aftershade::serve {

struct ServeOptions {
    std::filesystem::path look;
    std::string capture;  ///< as the user named it
    Sequence sequence;
    std::vector<Profile> profiles;
    ReadLimits limits{};
    gpu::Backend backend = gpu::Backend::automatic;
    std::filesystem::path data_folder;
    std::vector<std::filesystem::path> effect_folders;  ///< searched before the shipped one
    int port = 0;                                       ///< 0: a free one
    bool read_only = false;
    std::function<void(const std::string& address)> ready;  ///< once it answers

    StatusWriter* status = nullptr;  ///< receives which pass is compiled and drawn; may be null
    /// Called once `stop` is set: why the pass at work does not end; "" where it does, or none is at work.
    std::function<std::string()> hang{};
    /// Called where there is a reason: replaces this process by one with `handover`, and does not return.
    std::function<void(const std::string& handover)> restart{};
    std::string handover{};  ///< bytes of the server that this one replaces; "": none
};

/// Until `stop`. Throws Error: usage for the look and the port, capture for the first frame, gl for the
/// context.
void serve(const ServeOptions& options, const std::atomic<bool>& stop);

}  // namespace aftershade::serve
