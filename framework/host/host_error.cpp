#include "aftershade/error.h"

#include <algorithm>
#include <utility>

#include "framework/base/error.h"
#include "framework/base/memory_limit.h"
#include "framework/base/text.h"
#include "framework/host/failures.h"

namespace aftershade::host {

struct Error::Data {
    ErrorKind kind;
    std::vector<Diagnostic> diagnostics;
    std::size_t first = 0;  // error
    std::string text;
};

namespace {

ErrorKind kind_of(aftershade::ErrorKind kind) {
    switch (kind) {
        case aftershade::ErrorKind::usage: return ErrorKind::usage;
        case aftershade::ErrorKind::capture: return ErrorKind::capture;
        case aftershade::ErrorKind::gl: return ErrorKind::gl;
        case aftershade::ErrorKind::effect: break;
        case aftershade::ErrorKind::output: return ErrorKind::output;
        case aftershade::ErrorKind::memory: return ErrorKind::memory;
        case aftershade::ErrorKind::interrupted: return ErrorKind::interrupted;
    }
    return ErrorKind::effect;
}

}  // namespace

const char* error_kind_name(ErrorKind kind) noexcept {
    switch (kind) {
        case ErrorKind::usage: return "usage";
        case ErrorKind::document: return "document";
        case ErrorKind::capture: return "capture";
        case ErrorKind::gl: return "gl";
        case ErrorKind::effect: return "effect";
        case ErrorKind::output: return "output";
        case ErrorKind::memory: return "memory";
        case ErrorKind::interrupted: return "interrupted";
    }
    return "effect";
}

std::string to_string(const Diagnostic& diagnostic) {
    if (diagnostic.file.empty()) return diagnostic.message;
    std::string place = diagnostic.file;
    if (diagnostic.line > 0) place += ":" + std::to_string(diagnostic.line);
    if (diagnostic.column > 0) place += ":" + std::to_string(diagnostic.column);
    return place + ": " + (diagnostic.severity == Severity::error ? "error" : "warning") + ": " +
           diagnostic.message;
}

Error::Error(ErrorKind kind, std::vector<Diagnostic> diagnostics) {
    auto data = std::make_shared<Data>();
    data->kind = kind;
    data->diagnostics = std::move(diagnostics);
    if (data->diagnostics.empty()) data->diagnostics.push_back({});
    const auto is_error = [](const Diagnostic& d) { return d.severity == Severity::error; };
    const auto first = std::ranges::find_if(data->diagnostics, is_error);
    if (first != data->diagnostics.end()) data->first = std::size_t(first - data->diagnostics.begin());
    for (const Diagnostic& diagnostic : data->diagnostics)
        data->text += (data->text.empty() ? "" : "\n") + to_string(diagnostic);
    data_ = std::move(data);
}

Error::Error(ErrorKind kind, const std::string& message)
    : Error(kind, std::vector<Diagnostic>{{Severity::error, message, "", 0, 0}}) {}

Error::Error(const Error&) noexcept = default;
Error& Error::operator=(const Error&) noexcept = default;
Error::~Error() = default;

ErrorKind Error::kind() const noexcept {
    return data_->kind;
}
const char* Error::what() const noexcept {
    return data_->text.c_str();
}
const std::vector<Diagnostic>& Error::diagnostics() const noexcept {
    return data_->diagnostics;
}
const std::string& Error::message() const noexcept {
    return data_->diagnostics[data_->first].message;
}
const std::string& Error::file() const noexcept {
    return data_->diagnostics[data_->first].file;
}
int Error::line() const noexcept {
    return data_->diagnostics[data_->first].line;
}
int Error::column() const noexcept {
    return data_->diagnostics[data_->first].column;
}

void fail(ErrorKind kind, const std::string& message) {
    throw Error(kind, message);
}

void fail_at(ErrorKind kind, const std::string& file, const std::string& message) {
    throw Error(kind, {{Severity::error, message, file, 0, 0}});
}

std::vector<Diagnostic> public_diagnostics(const std::vector<aftershade::Diagnostic>& faults) {
    std::vector<Diagnostic> result;
    for (const aftershade::Diagnostic& fault : faults)
        result.push_back({fault.severity == aftershade::Severity::error ? Severity::error : Severity::warning,
                          fault.message, fault.place.file, fault.place.line, fault.place.column});
    return result;
}

void stop_at_errors(ErrorKind kind, const Diagnostics& diagnostics) {
    if (diagnostics.has_errors()) throw Error(kind, public_diagnostics(diagnostics.all()));
}

void rethrow() {
    try {
        throw;
    } catch (const Error&) {
        throw;
    } catch (const aftershade::Error& error) {
        if (is_out_of_memory(error)) throw Error(ErrorKind::memory, out_of_memory_text(error));
        throw Error(kind_of(error.kind()), public_diagnostics(error.faults()));
    } catch (const std::exception& error) {
        if (is_out_of_memory(error)) throw Error(ErrorKind::memory, out_of_memory_text(error));
        throw Error(ErrorKind::effect,
                    std::string("a fault of the library itself: ") + error.what() + "; please report it");
    }
}

}  // namespace aftershade::host
