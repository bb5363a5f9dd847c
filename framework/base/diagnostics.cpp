#include "framework/base/diagnostics.h"

#include "framework/base/text.h"

#include <algorithm>
#include <numeric>
#include <utility>

namespace aftershade {

Place option_place(Option option, std::string value) {
    return {.file = std::move(value), .option = option};
}

std::string to_string(const Place& place) {
    // As long as a path may be on Linux (PATH_MAX). Longer places are values that the command line was given.
    constexpr std::size_t kLongest = 4096, kShown = 120;
    const std::string file = !place.option        ? place.file
                             : place.file.empty() ? spelled(*place.option)
                                                  : spelled(*place.option) + " " + place.file;
    if (file.size() > kLongest)
        return file.substr(0, kShown) + "... (" + std::to_string(file.size()) + " bytes)";
    if (place.line == 0) return file;
    return place.file + ":" + std::to_string(place.line) + ":" + std::to_string(place.column);
}

void Diagnostics::add(Severity severity, const Place& place, std::string message) {
    if (place.copy > 0 && copies_.try_emplace(to_string(place), place.copy).first->second != place.copy)
        return;
    if (!place.turn.empty()) message += " (" + place.turn + ")";
    if (severity == Severity::error) ++error_count_;
    all_.push_back({severity, place, std::move(message)});
}

void Diagnostics::error(const Place& place, std::string message) {
    add(Severity::error, place, std::move(message));
}

void Diagnostics::warning(const Place& place, std::string message) {
    add(Severity::warning, place, std::move(message));
}

void Diagnostics::print(std::ostream& out) const {
    for (const Diagnostic& d : all_) {
        const char* kind = d.severity == Severity::error ? "error" : "warning";
        out << printable(to_string(d.place)) << ": " << kind << ": " << printable(d.message) << "\n";
    }
}

namespace {

/// Optimal string alignment: insertions, deletions, substitutions and swaps of neighbours cost 1.
std::size_t edit_distance(std::string_view a, std::string_view b) {
    std::vector<std::size_t> before(b.size() + 1), last(b.size() + 1), now(b.size() + 1);
    std::iota(last.begin(), last.end(), std::size_t{0});
    for (std::size_t i = 1; i <= a.size(); ++i) {
        now[0] = i;
        for (std::size_t j = 1; j <= b.size(); ++j) {
            const std::size_t change = last[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
            now[j] = std::min({last[j] + 1, now[j - 1] + 1, change});
            if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
                now[j] = std::min(now[j], before[j - 2] + 1);
        }
        std::swap(before, last);
        std::swap(last, now);
    }
    return last[b.size()];
}

}  // namespace

std::string did_you_mean(std::string_view word, std::span<const std::string> candidates,
                         std::string_view otherwise) {
    constexpr std::size_t kLongestWord = 100;
    const std::string* best = nullptr;
    std::size_t best_distance = std::max<std::size_t>(2, word.size() / 3) + 1;
    for (const std::string& candidate : candidates) {
        const bool begins = word.size() >= 3 && candidate.starts_with(word);
        const std::size_t longer = std::max(word.size(), candidate.size());
        // Each missing character is a change, so that long untrusted texts cost nothing.
        if (longer > kLongestWord || longer - std::min(word.size(), candidate.size()) >= best_distance) {
            if (!begins) continue;
        }
        const std::size_t distance = begins ? 1 : edit_distance(word, candidate);
        // A distance of the word's own length means that nothing of it was kept.
        if (distance < best_distance && distance < longer) {
            best = &candidate;
            best_distance = distance;
        }
    }
    return best ? "; did you mean '" + *best + "'?" : std::string(otherwise);
}

std::string list_of_names(std::span<const std::string> names, std::string_view conjunction) {
    std::vector<std::string> quoted;
    for (const std::string& name : names) quoted.push_back("'" + name + "'");
    return joined(quoted, " " + std::string(conjunction) + " ");
}

}  // namespace aftershade
