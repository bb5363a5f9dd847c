// --backend, shared by every verb that needs GL.
#pragma once

#include <CLI/CLI.hpp>
#include <cstdlib>
#include <string>

#include "framework/core/error.h"
#include "framework/gpu/context.h"

namespace aftershade::cli {

inline void add_backend_option(CLI::App& app, std::string& backend) {
    app.add_option("--backend", backend,
                   "auto, egl, egl-software or osmesa (default: $AFTERSHADE_BACKEND, else auto)");
}

/// Throws Error(ExitCode::usage) for a name that is none, telling where it came from.
inline gpu::Backend chosen_backend(const std::string& option) {
    const char* environment = std::getenv("AFTERSHADE_BACKEND");
    const bool from_environment = option.empty() && environment && *environment;
    const std::string name = from_environment ? environment : option.empty() ? "auto" : option;
    const auto backend = gpu::parse_backend(name);
    if (!backend)
        throw Error(ExitCode::usage, std::string(from_environment ? "AFTERSHADE_BACKEND" : "--backend") +
                                         ": '" + name +
                                         "' is not one of 'auto', 'egl', 'egl-software' or 'osmesa'");
    return *backend;
}

}  // namespace aftershade::cli
