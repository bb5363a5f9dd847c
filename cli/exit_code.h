// From the library's kinds of errors to the program's exit codes (docs/exit-codes.md).
#pragma once

#include "aftershade/error.h"
#include "framework/base/error.h"

namespace aftershade::cli {

constexpr ExitCode exit_code_of(host::ErrorKind kind) {
    switch (kind) {
        case host::ErrorKind::usage:
        case host::ErrorKind::document: return ExitCode::usage;
        case host::ErrorKind::capture: return ExitCode::capture;
        case host::ErrorKind::gl: return ExitCode::gl;
        case host::ErrorKind::output: return ExitCode::output;
        case host::ErrorKind::memory: return ExitCode::memory;
        case host::ErrorKind::interrupted: return ExitCode::interrupted;
        case host::ErrorKind::effect: break;
    }
    return ExitCode::effect;
}

}  // namespace aftershade::cli
