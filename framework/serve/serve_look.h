// A look over a capture on a page of this machine's browser: `aftershade serve`.
#pragma once

#include <atomic>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "framework/capture/profile.h"
#include "framework/capture/sequence.h"
#include "framework/effect/registry.h"
#include "framework/file/exr_file.h"
#include "framework/gpu/context.h"
#include "framework/serve/drawing_process.h"
#include "framework/serve/exporter.h"
#include "framework/serve/look_model.h"

namespace aftershade::serve {

struct ServeOptions {
    std::filesystem::path look;
    LookModel::File look_file = LookModel::File::there;
    std::string capture;  ///< as the user named it
    /// By its name on the command line or on disk. Throws Error.
    std::function<Sequence(const std::string& capture)> open_sequence;
    std::vector<Profile> profiles;
    ReadLimits limits{};
    gpu::GlChoice gl{};
    std::function<void(const gpu::ContextInfo&)> drawn_by;  ///< called once, in the process that draws
    std::filesystem::path data_folder;
    std::vector<std::filesystem::path> effect_folders;  ///< searched before the shipped one
    int port = 0;                                       ///< 0: a free one
    bool read_only = false;
    std::function<void(const std::string& address)> ready;  ///< once it answers
    std::function<void()> opened;  ///< a page with the token asked for the first time; on any thread

    /// Runs the process that draws. Called again, on another thread, where it has ended.
    RunDrawer run_drawer;
    /// The same, of one that gets no time that others want.
    RunDrawer run_thumbnail_drawer;
    RunExport run_export;
};

/// Those of the options' folders and the shipped ones, read now.
std::shared_ptr<EffectRegistry> find_effects(const ServeOptions& options);

/// Until `stop`, which ends the process that draws, too. Throws Error: usage for the look and the port,
/// capture for the first frame, gl for the context.
void serve(const ServeOptions& options, const std::atomic<bool>& stop);

}  // namespace aftershade::serve
