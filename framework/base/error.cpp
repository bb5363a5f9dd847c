#include "framework/base/error.h"

#include <sstream>

namespace aftershade {

namespace {

std::string lines_of(const Diagnostics& faults) {
    std::ostringstream text;
    faults.print(text);
    std::string lines = text.str();
    if (lines.ends_with('\n')) lines.pop_back();
    return lines;
}

}  // namespace

Error::Error(ErrorKind kind, const std::string& message)
    : std::runtime_error(message),
      kind_(kind),
      faults_(std::make_shared<std::vector<Diagnostic>>(1, Diagnostic{Severity::error, {}, message})) {}

Error::Error(ErrorKind kind, const Diagnostics& faults)
    : std::runtime_error(lines_of(faults)),
      kind_(kind),
      faults_(std::make_shared<std::vector<Diagnostic>>(faults.all())) {}

}  // namespace aftershade
