// From the errors of the modules below to those of the API.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "aftershade/error.h"
#include "framework/base/diagnostics.h"

namespace aftershade::host {

[[noreturn]] void fail(ErrorKind kind, const std::string& message);
/// `file` names what of the call is wrong: "bokeh.f_number", "HostOptions::data".
[[noreturn]] void fail_at(ErrorKind kind, const std::string& file, const std::string& message);

/// In the API's form.
std::vector<Diagnostic> public_diagnostics(const std::vector<aftershade::Diagnostic>& faults);
/// Throws Error where there is an error, with every warning too.
void stop_at_errors(ErrorKind kind, const Diagnostics& diagnostics);

/// Inside a catch block: throws what is being handled as an Error.
[[noreturn]] void rethrow();

/// Does what needs no Host, so that its errors are of the API.
template <typename Work>
auto with_public_errors(Work work) -> decltype(work()) {
    try {
        return work();
    } catch (...) {
        rethrow();
    }
}

}  // namespace aftershade::host
