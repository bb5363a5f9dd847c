// How every function of this library fails: by throwing Error. Functions that are noexcept never fail.
#pragma once

#include <exception>
#include <memory>
#include <string>
#include <vector>

#include "aftershade/export.h"

namespace aftershade::host {

/// The kind of failure, for programs; the message is for people. New kinds may come with a minor version:
/// treat one that you do not expect like `effect`.
enum class ErrorKind {
    usage,       ///< the calling program: a wrong argument, thread or order of calls, a value out of range
    document,    ///< a look, manifest, profile or capture.json does not parse or does not fit its effects
    capture,     ///< a file of pixels cannot be read, or an image that the look needs is missing or unfit
    gl,          ///< no usable GL
    effect,      ///< a shader, a plug-in or a pass failed
    output,      ///< a file cannot be written
    memory,      ///< memory ran out, of the process or of GL; the Host is closed then
    interrupted  ///< a stop was requested (RenderOptions::stop)
};

/// "usage", "document", ...: the enumerators' names. Never fails.
AFTERSHADE_API const char* error_kind_name(ErrorKind kind) noexcept;

enum class Severity { error, warning };

/// One fault, and where it is.
struct Diagnostic {
    Severity severity = Severity::error;
    std::string message;  ///< without its place and without a full stop
    /// A path; or what the caller named instead ("look text", "bokeh.f_number"); empty: no place.
    std::string file;
    int line = 0;    ///< from 1; 0: the whole file, or no file
    int column = 0;  ///< from 1, in bytes; 0: the whole line
};

/// "look.json:3:14: error: ...", without what is not known.
AFTERSHADE_API std::string to_string(const Diagnostic& diagnostic);

/// Copies share what they hold. [thread-safe to read]
class AFTERSHADE_API Error : public std::exception {
public:
    /// `diagnostics` must hold an error, which comes first.
    Error(ErrorKind kind, std::vector<Diagnostic> diagnostics);
    Error(ErrorKind kind, const std::string& message);
    Error(const Error&) noexcept;
    Error& operator=(const Error&) noexcept;
    ~Error() override;

    ErrorKind kind() const noexcept;
    /// Every fault, one a line: "look.json:3:14: error: bokeh has no parameter 'f_numer'; ...".
    const char* what() const noexcept override;
    /// Every fault and every warning of a document that was being read, at least one, in the order found.
    const std::vector<Diagnostic>& diagnostics() const noexcept;

    // Message and place of the first diagnostic that is an error.
    const std::string& message() const noexcept;
    const std::string& file() const noexcept;
    int line() const noexcept;
    int column() const noexcept;

private:
    struct AFTERSHADE_LOCAL Data;
    std::shared_ptr<const Data> data_;
};

}  // namespace aftershade::host
