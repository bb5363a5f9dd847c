// --backend and --device, shared by every verb that needs GL.
#pragma once

#include <optional>
#include <string>

#include "cli/cli11.h"
#include "framework/gpu/context.h"

namespace aftershade::cli {

struct GlOptions {
    std::string backend, device;  ///< as they are given; "" where they are not
};

/// `by_default` names a backend, for the help.
void add_gl_options(CLI::App& app, GlOptions& options, const std::string& by_default = "auto");

/// The options', else those of $AFTERSHADE_BACKEND and $AFTERSHADE_DEVICE, else auto and any. Of --device
/// all, the device of this worker or chunk, `part`, counted from 0; a process that is neither gets an error.
/// $AFTERSHADE_DEVICE says nothing of backends that draw in software. Throws Error(ErrorKind::usage) for an
/// unknown name, saying where it came from.
gpu::GlChoice chosen_gl(const GlOptions& options, std::optional<int> part = std::nullopt);

/// Warns where backend auto took software, and why.
void warn_of_software(const gpu::ContextInfo& gl);

}  // namespace aftershade::cli
