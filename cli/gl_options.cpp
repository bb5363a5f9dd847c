#include "cli/gl_options.h"

#include <CLI/CLI.hpp>
#include <cstdlib>
#include <iostream>

#include "framework/base/error.h"
#include "framework/base/text.h"
#include "framework/gpu/device.h"

namespace aftershade::cli {

namespace {

/// A word of the command line or, without it, of the environment.
struct Given {
    std::string value, source;
    bool is_environment = false;
};

Given given(const std::string& option, const char* name, const char* variable) {
    const char* environment = std::getenv(variable);
    if (option.empty() && environment && *environment) return {environment, variable, true};
    return {option, name};
}

gpu::Backend chosen_backend(const std::string& option) {
    const Given name = given(option, "--backend", "AFTERSHADE_BACKEND");
    if (name.value.empty()) return gpu::Backend::automatic;
    const auto backend = gpu::parse_backend(name.value);
    if (!backend)
        throw Error(ErrorKind::usage,
                    name.source + ": '" + name.value + "' is not one of " + gpu::backend_names());
    return *backend;
}

}  // namespace

void add_gl_options(CLI::App& app, GlOptions& options, const std::string& by_default) {
    app.add_option("--backend", options.backend,
                   "GL backend, one of " + gpu::backend_names() + " (default: $AFTERSHADE_BACKEND, else " +
                       by_default + ")");
    app.add_option("--device", options.device,
                   "Draw on this device, by a name that `aftershade doctor` lists: 0, card0, 0000:65:00.0, "
                   "GPU-6bcd0a81, cuda:0; all spreads workers and chunks over every GPU (default: "
                   "$AFTERSHADE_DEVICE, else the first that works)");
}

gpu::GlChoice chosen_gl(const GlOptions& options, std::optional<int> part) {
    const gpu::Backend backend = chosen_backend(options.backend);
    const Given name = given(options.device, "--device", "AFTERSHADE_DEVICE");
    const bool is_software = backend == gpu::Backend::software || backend == gpu::Backend::egl_software ||
                             backend == gpu::Backend::osmesa;
    if (name.value.empty() || (name.is_environment && is_software)) return backend;
    const bool is_all = !gpu::names_one_device(name.value);
    if (is_all && !part) {
        if (name.is_environment) return backend;
        throw Error(
            ErrorKind::usage,
            "--device all: spreads the workers of --jobs, the chunks of --chunk and the cases of golden "
            "over every GPU; add one of them, or name one device");
    }
    if (is_all) return {backend, gpu::device_of_part(gpu::list_devices(), backend, *part)};
    if (const std::string fault = gpu::device_fault(name.value); !fault.empty())
        throw Error(ErrorKind::usage, name.source + ": " + fault);
    return {backend, name.value};
}

void warn_of_software(const gpu::ContextInfo& gl) {
    if (!gl.hardware_fault.empty())
        std::cerr << "aftershade: warning: backend auto draws in software: " << printable(gl.hardware_fault)
                  << " (--backend egl refuses that)\n";
}

}  // namespace aftershade::cli
