// `serve` starts itself again where a pass does not come to an end: threads that GL works on cannot be ended
// alone.
#pragma once

#include <string>

namespace aftershade::cli {

/// Replaces this process by the same command, which finds `state` by state_before_restart(). Where the
/// system refuses, this process ends at once with code 5: nothing can wait for the thread that hangs.
[[noreturn]] void restart(const std::string& state);

/// "" where this process was not started by restart(). Call it once, before threads begin.
std::string state_before_restart();

}  // namespace aftershade::cli
