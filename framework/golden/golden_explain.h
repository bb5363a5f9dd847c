// Why a golden case differs: the first step that does, what of it has changed since the approval, and by
// which commits.
#pragma once

#include <atomic>
#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include "framework/golden/golden_run.h"

namespace aftershade {

/// Something that is not as it was when the image was approved.
struct OriginChange {
    std::string text;                  ///< "parameter bloom.radius is 40, was 20"
    std::filesystem::path document;    ///< that it stands in; "": none is known
    std::set<std::string> steps;       ///< that it can change; empty: any
    std::vector<std::string> commits;  ///< of the document, since the approval, the newest first
};

struct GoldenExplanation {
    GoldenImage image;                  ///< the first that differs; without a name all have the approved bits
    std::vector<std::string> messages;  ///< of a case that does not render, or crashed once
    std::string step, effect;           ///< the first that differs; "" where that is not known
    std::vector<std::string> outputs;   ///< of the step, that differ
    std::size_t steps_before = 0;       ///< that gave the approved bits
    std::vector<OriginChange> causes;   ///< what can have changed that step
    std::vector<OriginChange> others;   ///< other changes
    std::vector<std::string> notes;     ///< what could not be found out, and the remedy

    /// Whether nothing differs, or something is known that can have made the difference.
    bool is_explained() const {
        return !causes.empty() || (image.name.empty() && image.verdict <= Verdict::warning);
    }
};

/// Draws the case with its steps' outputs, in `work`. Throws Error(ErrorKind::output).
GoldenExplanation explain_case(const GoldenCase& test, const GoldenRunOptions& options,
                               const std::filesystem::path& suite_folder, const std::filesystem::path& work,
                               const std::atomic<bool>& interrupt);

/// Some lines, the last with its end.
std::string text_of(const GoldenCase& test, const GoldenExplanation& explanation);

}  // namespace aftershade
