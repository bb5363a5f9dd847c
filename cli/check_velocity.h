// inspect --check-velocity A B
#pragma once

#include <string>
#include <vector>

#include "cli/capture_options.h"
#include "framework/base/error.h"
#include "framework/batch/process_codes.h"

namespace aftershade::cli {

/// Warps one of two consecutive frames by its motion vectors and prints how well every reading of them
/// explains the other. ExitCode::done where the profile's reading is the best by a clear margin for every
/// velocity role that the files have, else ExitCode::partial. Throws Error(ErrorKind::capture) where they
/// have none.
ExitCode check_velocity_of_files(const std::vector<std::string>& files, const CaptureOptions& options,
                                 bool json);

}  // namespace aftershade::cli
