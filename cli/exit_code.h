// From kinds of errors to the program's exit codes (docs/exit-codes.md).
#pragma once

#include <exception>
#include <string>

#include "aftershade/error.h"
#include "framework/base/error.h"
#include "framework/batch/process_codes.h"
#include "framework/run/run_report.h"

namespace aftershade::cli {

/// An error whose code its kind does not say: `compare` and `golden` have idiff's.
class CodedError : public Error {
public:
    CodedError(ExitCode code, const std::string& message) : Error(ErrorKind::usage, message), code_(code) {}
    CodedError(ExitCode code, const Diagnostics& faults) : Error(ErrorKind::usage, faults), code_(code) {}
    ExitCode code() const { return code_; }

private:
    ExitCode code_;
};

ExitCode exit_code_of(ErrorKind kind);
ExitCode exit_code_of(host::ErrorKind kind);
/// The code of the error's kind; memory or effect for other exceptions.
ExitCode exit_code_of(const std::exception& error);
ExitCode exit_code_of(const RunReport& report);

}  // namespace aftershade::cli
