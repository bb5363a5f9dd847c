// Where the threads of software GL run.
#pragma once

#include <sys/types.h>

#include <map>
#include <utility>
#include <vector>

namespace aftershade::gpu {

/// A core for each thread, if there are as many numbers of threads as cores; else nothing, because processes
/// with fewer threads than cores would all take the same ones. `threads` by number from 0: several screens
/// have threads of the same number.
std::vector<std::pair<pid_t, int>> placements(const std::multimap<int, pid_t>& threads,
                                              const std::vector<int>& cores);

/// Keeps each of llvmpipe's threads on a core of its own. They wake for each draw, and Linux wakes them near
/// the thread that waits for them: on a machine with other work both threads of two cores then share one for
/// milliseconds, which is as long as a pass takes.
void spread_software_threads();

}  // namespace aftershade::gpu
