// What ended the work, as an exception that carries the exit code of the command (docs/exit-codes.md).
#pragma once

#include <stdexcept>
#include <string>

namespace aftershade {

/// Exit codes of every verb but `compare` and `golden`, which keep idiff's.
enum class ExitCode : int {
    done = 0,          ///< everything asked for was written
    partial = 1,       ///< some frames done, some failed; or a verdict verb says no
    usage = 2,         ///< the user's words or documents are wrong
    capture = 3,       ///< no frame readable, or a role is missing
    gl = 4,            ///< no usable GL
    effect = 5,        ///< a shader, a plug-in or a pass failed
    output = 6,        ///< an output could not be written
    memory = 7,        ///< memory ran out
    interrupted = 130  ///< SIGINT or SIGTERM
};

/// A failure of the machine or of data, not of our own code (which asserts) nor of the user's documents
/// (Diagnostics). The message names the place, the thing, the value, the limit and the remedy, without a
/// trailing full stop.
class Error : public std::runtime_error {
public:
    Error(ExitCode code, const std::string& message) : std::runtime_error(message), code_(code) {}
    ExitCode exit_code() const { return code_; }

private:
    ExitCode code_;
};

}  // namespace aftershade
