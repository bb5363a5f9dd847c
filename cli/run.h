// The work of `aftershade run`, for the commands that run a look too.
#pragma once

#include "cli/run_arguments.h"
#include "framework/batch/process_codes.h"

namespace aftershade::cli {

/// Throws FaultyDocuments and Error.
ExitCode run(const RunArguments& options);

}  // namespace aftershade::cli
