// Faults in the user's documents, collected so that all of them are printed at once, like a compiler.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <ostream>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "framework/base/option.h"

namespace aftershade {

/// Where a fault is. line 0: the whole file, or no file at all (then `file` says what).
struct Place {
    std::string file;  ///< or the value of `option`
    int line = 0;      ///< 1-based
    int column = 0;    ///< 1-based, in bytes
    std::optional<Option> option = std::nullopt;
    /// Where a manifest's group or `for` writes out a declaration: which copy, from 1; the variable, "level =
    /// 3".
    int copy = 0;
    std::string turn = {};
};

/// The chosen value, such as "bokeh.taps=2" for Option::set.
Place option_place(Option option, std::string value = "");

/// "file:line:column", "file" where there is no line, or "--set bokeh.taps=2" as the front end spells it.
std::string to_string(const Place& place);

enum class Severity { error, warning };

struct Diagnostic {
    Severity severity = Severity::error;
    Place place;
    std::string message;
};

/// Where a declaration has several copies, only the first with a fault at a place reports faults there, and
/// says its turn. [one thread at a time]
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

    /// Every reader of documents notes them here, whether or not they have faults, so that InputFiles can
    /// hold outputs against all of them.
    void note_document(const std::filesystem::path& file) { documents_.push_back(file); }
    const std::vector<std::filesystem::path>& documents() const { return documents_; }

private:
    void add(Severity severity, const Place& place, std::string message);

    std::vector<Diagnostic> all_;
    std::map<std::string, int> copies_;  // with faults, by place
    int error_count_ = 0;
    std::vector<std::filesystem::path> documents_;
};

/// "; did you mean 'focus_distance'?" where a candidate is close enough to `word` by edit distance, else
/// `otherwise`.
std::string did_you_mean(std::string_view word, std::span<const std::string> candidates,
                         std::string_view otherwise = "");

/// "'a', 'b' or 'c'", for messages.
std::string list_of_names(std::span<const std::string> names, std::string_view conjunction = "or");

}  // namespace aftershade
