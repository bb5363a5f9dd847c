#include "aftershade/error.h"

#include <algorithm>
#include <charconv>
#include <optional>
#include <string_view>
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

std::optional<int> number_before(std::string_view& text) {
    const std::size_t colon = text.rfind(':');
    int number = 0;
    if (colon == std::string_view::npos) return std::nullopt;
    const char* const end = text.data() + text.size();
    const auto [rest, failure] = std::from_chars(text.data() + colon + 1, end, number);
    if (failure != std::errc{} || rest != end || number < 1) return std::nullopt;
    text = text.substr(0, colon);
    return number;
}

/// "coc.frag:6:17: error: 'parm' undeclared"; nullopt for a line that names no line of a file.
std::optional<Diagnostic> diagnostic_of_line(std::string_view line) {
    constexpr std::string_view kMark = ": error: ";
    const std::size_t mark = line.find(kMark);
    if (mark == std::string_view::npos) return std::nullopt;
    std::string_view place = line.substr(0, mark);
    Diagnostic diagnostic;
    diagnostic.message = line.substr(mark + kMark.size());
    const auto last = number_before(place);
    const auto before = last ? number_before(place) : std::nullopt;
    if (!last) return std::nullopt;
    diagnostic.line = before ? *before : *last;
    diagnostic.column = before ? *last : 0;
    diagnostic.file = place;
    return diagnostic;
}

std::vector<Diagnostic> diagnostics_of_text(const std::string& text) {
    std::vector<Diagnostic> diagnostics;
    for (std::size_t begin = 0; begin <= text.size();) {
        const std::size_t end = std::min(text.find('\n', begin), text.size());
        const std::string line = text.substr(begin, end - begin);
        begin = end + 1;
        if (auto diagnostic = diagnostic_of_line(line)) diagnostics.push_back(std::move(*diagnostic));
        else if (diagnostics.empty()) diagnostics.push_back({Severity::error, line, "", 0, 0});
        else diagnostics.back().message += "\n" + line;
    }
    return diagnostics;
}

ErrorKind kind_of(ExitCode code) {
    switch (code) {
        case ExitCode::usage: return ErrorKind::usage;
        case ExitCode::capture: return ErrorKind::capture;
        case ExitCode::gl: return ErrorKind::gl;
        case ExitCode::output: return ErrorKind::output;
        case ExitCode::memory: return ErrorKind::memory;
        case ExitCode::interrupted: return ErrorKind::interrupted;
        case ExitCode::effect:
        case ExitCode::partial:
        case ExitCode::done: break;
    }
    return ErrorKind::effect;
}

/// What the command line calls "--tap x" or "-o x" is x here.
std::string public_place(const std::string& place) {
    for (const std::string_view option : {"--tap ", "--output-roles ", "--compression ", "-o ", "--set "})
        if (place.starts_with(option)) return place.substr(option.size());
    return place;
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

std::vector<Diagnostic> public_diagnostics(const Diagnostics& diagnostics) {
    std::vector<Diagnostic> result;
    for (const aftershade::Diagnostic& diagnostic : diagnostics.all())
        result.push_back(
            {diagnostic.severity == aftershade::Severity::error ? Severity::error : Severity::warning,
             diagnostic.message, public_place(diagnostic.place.file), diagnostic.place.line,
             diagnostic.place.column});
    return result;
}

void stop_at_errors(ErrorKind kind, const Diagnostics& diagnostics) {
    if (diagnostics.has_errors()) throw Error(kind, public_diagnostics(diagnostics));
}

void rethrow() {
    try {
        throw;
    } catch (const Error&) {
        throw;
    } catch (const aftershade::Error& error) {
        if (is_out_of_memory(error)) throw Error(ErrorKind::memory, out_of_memory_text(error));
        throw Error(kind_of(error.exit_code()), diagnostics_of_text(error.what()));
    } catch (const std::exception& error) {
        if (is_out_of_memory(error)) throw Error(ErrorKind::memory, out_of_memory_text(error));
        throw Error(ErrorKind::effect,
                    std::string("a fault of the library itself: ") + error.what() + "; please report it");
    }
}

}  // namespace aftershade::host
