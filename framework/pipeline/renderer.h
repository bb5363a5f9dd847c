// Runs a pipeline over captures on one GL context.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "framework/effect/pass_program.h"
#include "framework/graph/executor.h"
#include "framework/image/capture.h"
#include "framework/pipeline/audit.h"
#include "framework/pipeline/pipeline.h"

namespace aftershade {

struct FrameResult {
    std::map<std::string, Image> images;  ///< by role: what the steps made of the roles asked for
    std::map<std::string, Image> taps;    ///< by "step.texture"
    std::vector<graph::PassTime> times;   ///< upload, each pass, readback; empty unless timed
    std::vector<AuditFinding> audit;      ///< in the order of the passes; empty unless audited
};

/// Builds the frame graph on the first frame and again only when the size, the roles present, or a value that
/// chooses passes or programs changes. [the context's thread]
class PipelineRenderer {
public:
    PipelineRenderer(gpu::Context& context, const Pipeline& pipeline,
                     const std::filesystem::path& data_folder);
    ~PipelineRenderer();

    /// `roles` are read back where a step makes them. Throws Error(ExitCode::effect).
    FrameResult render(const Capture& capture, const std::vector<std::string>& roles, bool timed);
    /// Reads every input and every float texture back after its pass and looks for NaN and infinities. Slow.
    void set_audit(bool audit) { audit_ = audit; }

private:
    struct Built;
    std::string graph_key(const Capture& capture, const std::vector<ParamSet>& params,
                          const std::vector<std::string>& roles) const;
    std::unique_ptr<Built> build(const Capture& capture, const std::vector<ParamSet>& params,
                                 const std::vector<std::string>& roles);

    gpu::Context& context_;
    const Pipeline& pipeline_;
    ProgramCache programs_;
    std::unique_ptr<Built> built_;
    bool audit_ = false;
};

}  // namespace aftershade
