// The exception that ends the work.
#pragma once

#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "framework/base/diagnostics.h"

namespace aftershade {

enum class ErrorKind {
    usage,       ///< the user's words or documents are wrong
    capture,     ///< no frame readable, or a role is missing
    gl,          ///< no usable GL
    effect,      ///< a shader, a plug-in or a pass failed
    output,      ///< an output could not be written
    memory,      ///< memory ran out
    interrupted  ///< a stop was requested
};

/// A failure of the machine or of data, not of our own code (which asserts) nor of the user's documents
/// (Diagnostics). The message names the place, the thing, the value, the limit and the remedy, without a
/// trailing full stop.
class Error : public std::runtime_error {
public:
    Error(ErrorKind kind, const std::string& message);
    /// With the places of faults in documents and shaders; what() has a line for each.
    Error(ErrorKind kind, const Diagnostics& faults);
    ErrorKind kind() const { return kind_; }
    /// At least one; without a place where only the message says it.
    const std::vector<Diagnostic>& faults() const { return *faults_; }

private:
    ErrorKind kind_;
    std::shared_ptr<const std::vector<Diagnostic>> faults_;
};

}  // namespace aftershade
