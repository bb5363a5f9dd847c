// A look bound to its effects: what each step reads, and which values were asked for.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "framework/core/diagnostics.h"
#include "framework/core/param.h"
#include "framework/effect/manifest.h"
#include "framework/effect/registry.h"
#include "framework/image/capture.h"
#include "framework/pipeline/look.h"

namespace aftershade {

/// Where an input takes its image from.
struct InputSource {
    int step = -1;       ///< index of an earlier step; -1: the capture
    std::string output;  ///< that step's output; for the capture, the role
};

/// Sets of values, from the most to the least binding: --set, look, preset; below them come the capture and
/// the manifest.
struct PipelineStep {
    std::string name;
    const EffectManifest* manifest = nullptr;
    std::map<std::string, InputSource> inputs;   ///< by input name
    std::map<std::string, ParamValue> values;    ///< asked for by the user
    std::map<std::string, std::string> origins;  ///< of each of `values`: "--set", "the look", "preset fast"
};

/// "bokeh.coc": an intermediate to be written out.
struct Tap {
    std::string step;
    std::string texture;
    std::string text() const { return step + "." + texture; }
};

struct Pipeline {
    std::vector<PipelineStep> steps;
    std::vector<Tap> taps;

    /// Roles that some step takes from the capture, required or not, and `color` for the outputs.
    std::vector<std::string> capture_roles() const;
    bool writes_role(const std::string& role) const;
};

/// One "--set step.param=value" or "--tap step.texture", as given.
struct PipelineOptions {
    std::vector<std::string> sets;
    std::vector<std::string> taps;
};

/// Binds a look. Each input takes its role from the nearest earlier step that outputs it, else from the
/// capture, unless the step's "in" says otherwise. Faults go to `diagnostics`, all of them; the result is
/// usable if there was none.
Pipeline compile_pipeline(const Look& look, EffectRegistry& effects, const PipelineOptions& options,
                          Diagnostics& diagnostics);

/// Throws Error(ExitCode::capture) if the capture lacks a role that a step requires, naming the effect, the
/// role, and the channels that the file does have.
void require_capture_roles(const Pipeline& pipeline, const CaptureHeader& header);

/// Optional and required inputs of a step that have an image, given the capture's roles.
std::vector<std::string> present_inputs(const Pipeline& pipeline, int step,
                                        const std::vector<std::string>& capture_roles);

/// Every parameter of the step: the user's value, else the capture's (the manifest's "from"), else the
/// default. Throws Error(ExitCode::capture) if the capture's value is out of the parameter's range.
ParamSet resolve_params(const PipelineStep& step, const CaptureHeader& header);

/// One line per parameter of every step: its value, its unit, and where the value is from.
std::string explain_params(const Pipeline& pipeline, const CaptureHeader& header);

}  // namespace aftershade
