// Faults in the user's documents, collected so that all of them are printed at once, like a compiler.
#pragma once

#include <ostream>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace aftershade {

/// Where a fault is. line 0: the whole file, or no file at all (then `file` says what, such as "--set
/// bokeh.taps=2").
struct Place {
    std::string file;
    int line = 0;    ///< 1-based
    int column = 0;  ///< 1-based, in bytes
};

/// "file:line:column", or "file" where there is no line.
std::string to_string(const Place& place);

enum class Severity { error, warning };

struct Diagnostic {
    Severity severity = Severity::error;
    Place place;
    std::string message;
};

/// [one thread at a time]
class Diagnostics {
public:
    void error(const Place& place, std::string message);
    void warning(const Place& place, std::string message);
    bool has_errors() const { return error_count_ > 0; }
    int error_count() const { return error_count_; }
    const std::vector<Diagnostic>& all() const { return all_; }
    /// One line each: "file:line:column: error: message". Control characters, which names in documents may
    /// hold, become '?'.
    void print(std::ostream& out) const;

private:
    std::vector<Diagnostic> all_;
    int error_count_ = 0;
};

/// "; did you mean 'focus_distance'?" where a candidate is close enough to `word` by edit distance, else "".
std::string did_you_mean(std::string_view word, std::span<const std::string> candidates);

/// "'a', 'b' or 'c'", for messages.
std::string list_of_names(std::span<const std::string> names, std::string_view conjunction = "or");

}  // namespace aftershade
