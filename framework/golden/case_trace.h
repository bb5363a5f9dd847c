// The pieces that a golden case is made of now, and what each of its steps gives.
#pragma once

#include <atomic>
#include <filesystem>
#include <map>
#include <mutex>
#include <set>
#include <string>
#include <vector>

#include "framework/effect/registry.h"
#include "framework/golden/approved_image.h"
#include "framework/golden/bound_case.h"
#include "framework/golden/golden_render.h"

namespace aftershade {

/// A file or a value of a case.
struct CasePart {
    std::filesystem::path document;  ///< the file, or the one that the value stands in; "": none is known
    std::string kind;                ///< "shader", "module", "capture", "parameter"
    std::set<std::string> steps;     ///< that use it; empty: any may
};

struct CaseParts {
    CaseOrigin origin;  ///< without hashes of steps' outputs
    std::map<std::string, CasePart> files, values;
    std::map<std::string, std::string> effects;  ///< of each step
};

/// "shader", "module", "manifest", "profile", "native source", or "file".
std::string kind_of_file(const std::string& name);

/// Reads the pieces of cases, each file once. [thread-safe]
class CaseTracer {
public:
    /// Files are named from the folder of the suite, but shipped ones from the shipped data.
    CaseTracer(const GoldenRenderOptions& options, const std::filesystem::path& suite_folder);

    /// The parts of one frame's picture. A look with faults has none, and files that cannot be read are
    /// left out.
    CaseParts parts(const GoldenCase& test, int frame);
    /// "bloom.color": each output of each step, in the look's order.
    std::vector<std::string> taps(const GoldenCase& test);

private:
    void add_file(const std::filesystem::path& file, CasePart part, CaseParts& parts);
    void add_step(const PipelineStep& step, const GoldenCase& test, CaseParts& parts);
    std::string name_of(const std::filesystem::path& file) const;

    EffectRegistry effects_;
    std::filesystem::path data_, suite_folder_;
    std::map<std::filesystem::path, std::string> hashes_;
    std::mutex mutex_;
};

struct TracedCase {
    RenderedCase rendered;                         ///< the case's own images
    std::map<int, std::vector<StepHashes>> steps;  ///< by frame
};

/// Draws the case and hashes what these taps hold. Throws as render_case().
TracedCase render_traced(const GoldenCase& test, const std::vector<std::string>& taps,
                         const GoldenRenderOptions& options, const std::filesystem::path& work,
                         const std::atomic<bool>& interrupt);

}  // namespace aftershade
