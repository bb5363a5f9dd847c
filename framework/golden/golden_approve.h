// New approved images for a golden suite.
#pragma once

#include <atomic>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "framework/golden/golden_run.h"

namespace aftershade {

struct GoldenApproveOptions {
    GoldenRunOptions run;
    bool add = false;             ///< beside those of other renderers, instead of in place of the first
    bool renew_sidecars = false;  ///< where the bits are equal, record again what gives them
    std::string command;          ///< for the sidecars
    std::string approver;         ///< for those of images with new bits; "": no one is named
    std::string approved;         ///< the day, UTC
    /// What stands against a new image, with those approved by its name; "": nothing. A case with such an
    /// image keeps its goldens. [called by one thread at a time]
    std::function<std::string(const GoldenCase& test, const RenderedImage& image,
                              const std::vector<ApprovedImage>& approved)>
        why_not{};
};

struct GoldenApproval {
    std::vector<std::filesystem::path> written;   ///< images, each with its sidecar
    std::vector<std::filesystem::path> renewed;   ///< sidecars alone
    std::vector<std::filesystem::path> outdated;  ///< approved by other renderers, of another look or effects
    std::size_t unchanged = 0;                    ///< images whose bits are approved already
    std::vector<GoldenCaseResult>
        cases;  ///< with verdict and messages of those that keep their goldens or crashed once
    Verdict verdict = Verdict::same;  ///< the worst
    bool interrupted = false;         ///< then nothing was written
};

/// "" where the cases' goldens are of the kind of renderer of `environment`, software or hardware, or have no
/// sidecars; else what stands against it.
std::string foreign_goldens(const GoldenSuite& suite, const GoldenRunOptions& options);

/// Renders the cases that fit the filters. An image with new bits is put beside its golden under another name
/// and, when every case has ended, renamed into place, then its sidecar: a process that is killed leaves old
/// files or new ones, each whole. In place of: this renderer's own approved image; else the first of its
/// name, or with `add` one with the renderer's key. Throws Error(ErrorKind::output).
GoldenApproval approve_goldens(const GoldenSuite& suite, const GoldenApproveOptions& options,
                               const GoldenListener& listener, const std::atomic<bool>& interrupt);

}  // namespace aftershade
