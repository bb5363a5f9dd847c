// An export of the page of `aftershade serve`: the same command once more, as a process that runs the look.
#pragma once

#include "cli/run_arguments.h"
#include "framework/batch/process_codes.h"
#include "framework/batch/watchdog.h"
#include "framework/serve/exporter.h"

namespace aftershade::cli {

/// Set for that process, to the folder that Exporter made for the job.
inline constexpr const char* kExportVariable = "AFTERSHADE_SERVE_EXPORT";

serve::RunExport export_runner(PassLimit limit);

/// In that process. Throws Error(ErrorKind::usage) where the folder has no job.
serve::ExportJob read_export_job();
/// `arguments` has the options of the command, and the capture.
ExitCode run_export(const serve::ExportJob& job, RunArguments arguments);

}  // namespace aftershade::cli
