// The file of --report while a run has not come as far as to write it.
#pragma once

#include <string>

#include "cli/run_arguments.h"
#include "framework/batch/process_codes.h"

namespace aftershade::cli {

/// Removes the report of an earlier run, which would pass for the report of this one. Other files stay: the
/// checks of the outputs refuse them.
void remove_old_report(const RunArguments& options);

/// A report without frames, of a run that ended before its first one; keeps a file that is there.
void write_early_report(const RunArguments& options, ExitCode code, const std::string& message);

}  // namespace aftershade::cli
