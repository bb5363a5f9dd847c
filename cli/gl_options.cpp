#include "cli/gl_options.h"

#include <CLI/CLI.hpp>
#include <cstdlib>

#include "framework/base/error.h"

namespace aftershade::cli {

std::string backend_help(const std::string& by_default) {
    return "GL backend, one of " + gpu::backend_names() + " (default: $AFTERSHADE_BACKEND, else " +
           by_default + ")";
}

void add_backend_option(CLI::App& app, std::string& backend) {
    app.add_option("--backend", backend, backend_help("auto"));
}

gpu::Backend chosen_backend(const std::string& option) {
    const char* environment = std::getenv("AFTERSHADE_BACKEND");
    const bool from_environment = option.empty() && environment && *environment;
    const std::string name = from_environment ? environment : option.empty() ? "auto" : option;
    const auto backend = gpu::parse_backend(name);
    if (!backend)
        throw Error(ErrorKind::usage, std::string(from_environment ? "AFTERSHADE_BACKEND" : "--backend") +
                                          ": '" + name + "' is not one of " + gpu::backend_names());
    return *backend;
}

}  // namespace aftershade::cli
