#include "cli/exit_code.h"

#include "framework/base/memory_limit.h"

namespace aftershade::cli {

ExitCode exit_code_of(ErrorKind kind) {
    switch (kind) {
        case ErrorKind::usage: return ExitCode::usage;
        case ErrorKind::capture: return ExitCode::capture;
        case ErrorKind::gl: return ExitCode::gl;
        case ErrorKind::effect: break;
        case ErrorKind::output: return ExitCode::output;
        case ErrorKind::memory: return ExitCode::memory;
        case ErrorKind::interrupted: return ExitCode::interrupted;
    }
    return ExitCode::effect;
}

ExitCode exit_code_of(host::ErrorKind kind) {
    switch (kind) {
        case host::ErrorKind::usage:
        case host::ErrorKind::document: return ExitCode::usage;
        case host::ErrorKind::capture: return ExitCode::capture;
        case host::ErrorKind::gl: return ExitCode::gl;
        case host::ErrorKind::effect: break;
        case host::ErrorKind::output: return ExitCode::output;
        case host::ErrorKind::memory: return ExitCode::memory;
        case host::ErrorKind::interrupted: return ExitCode::interrupted;
    }
    return ExitCode::effect;
}

ExitCode exit_code_of(const std::exception& error) {
    if (const auto* coded = dynamic_cast<const CodedError*>(&error)) return coded->code();
    if (const auto* own = dynamic_cast<const Error*>(&error)) return exit_code_of(own->kind());
    return is_out_of_memory(error) ? ExitCode::memory : ExitCode::effect;
}

ExitCode exit_code_of(const RunReport& report) {
    if (report.interrupted) return ExitCode::interrupted;
    if (report.failures.empty()) return report.has_frames() ? ExitCode::done : ExitCode::capture;
    return report.has_frames() ? ExitCode::partial : exit_code_of(report.failures.front().kind);
}

}  // namespace aftershade::cli
