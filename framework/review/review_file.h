// The decisions of a review, in a file of the report's folder that several reviewers write.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "framework/batch/golden_decisions.h"

namespace aftershade::review {

/// Each call reads the file: another process may have written it. A write replaces it only if it still holds
/// what was read, so that no reviewer's decision is lost. [thread-safe]
class ReviewFile {
public:
    explicit ReviewFile(std::filesystem::path report) : report_(std::move(report)) {}

    /// Throws Error(ErrorKind::capture) for a faulty file.
    std::vector<GoldenDecision> read() const;

    /// Applies `change` to what the file holds, as often as another one writes it meanwhile. `change` returns
    /// false to write nothing. Throws Error(ErrorKind::output).
    void update(const std::function<bool(std::vector<GoldenDecision>& decisions)>& change) const;

    static constexpr const char* kName = "decisions.json";

private:
    std::string text() const;
    std::vector<GoldenDecision> parsed(const std::string& text) const;

    std::filesystem::path report_;
};

/// Changes with every key of a decision: what a page shows is known by it.
std::string revision_of(const GoldenDecision& decision);

}  // namespace aftershade::review
