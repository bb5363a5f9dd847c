// --backend, shared by every verb that needs GL.
#pragma once

#include <string>

#include "framework/gpu/context.h"

namespace CLI {
class App;
}  // namespace CLI

namespace aftershade::cli {

/// What the option's line says; `by_default` names a backend.
std::string backend_help(const std::string& by_default);

void add_backend_option(CLI::App& app, std::string& backend);

/// The option's, else that of $AFTERSHADE_BACKEND, else auto. Throws Error(ErrorKind::usage) for an unknown
/// name, saying where it came from.
gpu::Backend chosen_backend(const std::string& option);

}  // namespace aftershade::cli
