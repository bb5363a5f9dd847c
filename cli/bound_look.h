// A look of the command line, bound to its effects, and the files that its run reads and writes.
#pragma once

#include <memory>
#include <optional>
#include <utility>

#include "cli/run_arguments.h"
#include "framework/base/diagnostics.h"
#include "framework/base/input_files.h"
#include "framework/capture/sequence.h"
#include "framework/effect/registry.h"
#include "framework/look/look.h"
#include "framework/look/pipeline.h"
#include "framework/run/run_options.h"

namespace aftershade::cli {

/// The look and its effects as they are on disk now; a pipeline refers to the effects.
struct BoundLook {
    explicit BoundLook(EffectRegistry found) : effects(std::move(found)) {}
    EffectRegistry effects;
    std::optional<Look> look;
    Pipeline pipeline;
};

/// Reads the documents as they are now. After a fault the look or the pipeline is empty.
std::unique_ptr<BoundLook> bind_look(const RunArguments& options, Diagnostics& diagnostics);

/// Every document that was read, the shaders of effects, values' files and masks, and the capture's frames.
/// The history that is read is none of them: a run may write the next one over it. After faults the look may
/// not be whole, and names no files.
InputFiles run_inputs(const BoundLook& bound, const Sequence& sequence, const Diagnostics& faults);

/// Every file of `run`: those of frames, and those that are written once. Whether --report may be written.
bool check_run_outputs(const RunArguments& options, const OutputOptions& outputs, const Sequence& sequence,
                       InputFiles& inputs, Diagnostics& diagnostics);

}  // namespace aftershade::cli
