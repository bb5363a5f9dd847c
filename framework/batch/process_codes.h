// The exit codes of the command, by which processes that work for one another tell how they ended.
#pragma once

namespace aftershade {

/// Every verb has these but `compare` and `golden`, which keep idiff's (docs/exit-codes.md).
enum class ExitCode : int {
    done = 0,     ///< everything asked for was written
    partial = 1,  ///< some frames done, some failed; or a verdict verb says no
    usage = 2,    ///< ErrorKind::usage, and so on
    capture = 3,
    gl = 4,
    effect = 5,
    output = 6,
    memory = 7,
    interrupted = 130  ///< SIGINT or SIGTERM
};

}  // namespace aftershade
