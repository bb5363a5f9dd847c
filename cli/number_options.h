// Numbers of the command line.
#pragma once

#include "cli/cli11.h"

namespace aftershade::cli {

/// Its value is a number of bytes above 0: 4GB, 512MiB, 1048576. kB and KiB are both 1024 bytes.
CLI::Option* takes_bytes(CLI::Option* option);

/// After all options of `app` and its verbs are declared: values that would slip past their limits are
/// refused. NaN compares as within all limits, and a number below 0 or above 2^64 - 1 wraps or saturates.
void refuse_odd_numbers(CLI::App& app);

}  // namespace aftershade::cli
