// Inputs of a run, compared with its outputs.
#pragma once

#include "cli/bound_look.h"
#include "cli/run_arguments.h"
#include "framework/base/diagnostics.h"
#include "framework/base/input_files.h"
#include "framework/capture/sequence.h"
#include "framework/run/output_options.h"

namespace aftershade::cli {

/// Every document that was read, the shaders of effects, values' files and masks, and the capture's frames.
/// The history that is read is none of them: a run may write the next one over it. After faults the look may
/// not be whole, and names no files.
InputFiles run_inputs(const BoundLook& bound, const Sequence& sequence, const Diagnostics& faults);

/// Every file of `run`: those of frames, and those that are written once. Whether --report may be written.
bool check_run_outputs(const RunArguments& options, const OutputOptions& outputs, const Sequence& sequence,
                       InputFiles& inputs, Diagnostics& diagnostics);

}  // namespace aftershade::cli
