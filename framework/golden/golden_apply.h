// What decisions do to a golden suite: the images that they approve, drawn here and written as
// `golden approve` writes them.
#pragma once

#include <atomic>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "framework/golden/golden_approve.h"
#include "framework/golden/golden_decisions.h"

namespace aftershade {

struct GoldenApplyOptions {
    GoldenApproveOptions approve;              ///< its filters, approver and `add` are the decisions'
    std::optional<GoldenApprovers> approvers;  ///< nullopt: everyone may
    bool any_renderer = false;
    /// The file that the reviewer looked at, of a case and an image; nullptr: only the decision's hash
    /// counts. Throws Error where it cannot be read.
    std::function<std::string(const std::string& test, const std::string& image)> seen_bytes{};
};

struct GoldenApplied {
    GoldenApproval approval;              ///< of all decisions; its cases refer to the suite
    std::vector<GoldenDecision> applied;  ///< of one case each; their images are in the suite
    std::vector<GoldenDecision> rejections;
    std::vector<std::string> kept;  ///< why cases keep their goldens: "lens: ...", a line for each reason
};

/// The last decision about each case; a decision with a glob becomes one for each case that it matches. A
/// name that matches no case is a fault, and so is an author who may not approve: nothing is applied in part.
std::vector<GoldenDecision> resolve_decisions(const GoldenSuite& suite,
                                              const std::vector<GoldenDecision>& decisions,
                                              const std::optional<GoldenApprovers>& approvers,
                                              Diagnostics& diagnostics);

/// Draws the approved cases and writes their images. A case stays as it was where it draws other bits than
/// those that were seen, or where its approved image is not the one that was seen; its messages say so.
/// Throws Error(ErrorKind::output); Error(ErrorKind::usage) for another kind of renderer.
GoldenApplied apply_decisions(const GoldenSuite& suite, const std::vector<GoldenDecision>& resolved,
                              const GoldenApplyOptions& options, const GoldenListener& listener,
                              const std::atomic<bool>& interrupt);

}  // namespace aftershade
